//! The functions of the C library, and objects that call them.
#![allow(unsafe_code, reason = "the boundary to the C library")]

use std::ffi::{CStr, c_char, c_int, c_void};
use std::fmt;
use std::marker::PhantomData;
use std::ptr::{self, NonNull};

use super::DenoiseError;

/// `OIDNDeviceImpl`.
#[repr(C)]
struct DeviceImpl {
    _private: [u8; 0],
}

/// `OIDNFilterImpl`.
#[repr(C)]
struct FilterImpl {
    _private: [u8; 0],
}

/// `OIDN_DEVICE_TYPE_CPU`: it reads and writes the memory of the program.
const DEVICE_TYPE_CPU: c_int = 1;
/// `OIDN_FORMAT_FLOAT3`
const FORMAT_FLOAT3: c_int = 3;
/// `OIDN_ERROR_NONE`
const ERROR_NONE: c_int = 0;

macro_rules! functions {
    ($($name:ident: fn($($argument:ty),*) $(-> $result:ty)?;)*) => {
        /// The functions that are used, by their names in `OpenImageDenoise/oidn.h` of version 2.
        #[allow(non_snake_case, reason = "the names of the C functions")]
        struct Functions {
            $($name: unsafe extern "C" fn($($argument),*) $(-> $result)?,)*
        }

        impl Functions {
            fn of(library: &libloading::Library) -> Result<Self, libloading::Error> {
                Ok(Self {
                    $($name: {
                        // SAFETY: the type is that of the function of this name in the header.
                        let symbol = unsafe { library.get(concat!(stringify!($name), "\0").as_bytes()) };
                        *symbol?
                    },)*
                })
            }
        }
    };
}

functions! {
    oidnNewDevice: fn(c_int) -> *mut DeviceImpl;
    oidnSetDeviceInt: fn(*mut DeviceImpl, *const c_char, c_int);
    oidnSetDeviceBool: fn(*mut DeviceImpl, *const c_char, bool);
    oidnCommitDevice: fn(*mut DeviceImpl);
    oidnGetDeviceError: fn(*mut DeviceImpl, *mut *const c_char) -> c_int;
    oidnReleaseDevice: fn(*mut DeviceImpl);
    oidnNewFilter: fn(*mut DeviceImpl, *const c_char) -> *mut FilterImpl;
    oidnSetSharedFilterImage: fn(*mut FilterImpl, *const c_char, *mut c_void, c_int, usize, usize, usize, usize, usize);
    oidnSetFilterBool: fn(*mut FilterImpl, *const c_char, bool);
    oidnCommitFilter: fn(*mut FilterImpl);
    oidnExecuteFilter: fn(*mut FilterImpl);
    oidnReleaseFilter: fn(*mut FilterImpl);
}

/// The loaded library.
pub struct Library {
    functions: Functions,
    /// The functions are valid as long as this is.
    _library: libloading::Library,
}

impl fmt::Debug for Library {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        formatter.debug_struct("Library").finish_non_exhaustive()
    }
}

impl Library {
    pub fn load(name: &str) -> Result<Self, DenoiseError> {
        let failed = |source| DenoiseError::Load { source };
        // SAFETY: the initializers of the library have no conditions for their caller.
        let library = unsafe { libloading::Library::new(name) }.map_err(failed)?;
        let functions = Functions::of(&library).map_err(failed)?;
        Ok(Self {
            functions,
            _library: library,
        })
    }
}

/// An image in the memory of the program, which is borrowed as long as it is used.
pub struct Image<'a> {
    name: &'static CStr,
    first: *mut c_void,
    size: [usize; 2],
    borrowed: PhantomData<&'a mut [[f32; 3]]>,
}

impl<'a> Image<'a> {
    /// An image that is read only. `size` is its width and height.
    pub fn read(name: &'static CStr, pixels: &'a [[f32; 3]], [width, height]: [usize; 2]) -> Self {
        assert_eq!(pixels.len(), width * height, "all pixels");
        Self {
            name,
            first: pixels.as_ptr().cast_mut().cast(),
            size: [width, height],
            borrowed: PhantomData,
        }
    }

    /// The image that is read and replaced.
    pub fn replaced(pixels: &'a mut [[f32; 3]], [width, height]: [usize; 2]) -> Self {
        assert_eq!(pixels.len(), width * height, "all pixels");
        Self {
            name: c"color",
            first: pixels.as_mut_ptr().cast(),
            size: [width, height],
            borrowed: PhantomData,
        }
    }
}

/// A device of the library that computes on the processor.
pub struct Device<'a> {
    functions: &'a Functions,
    device: NonNull<DeviceImpl>,
}

impl<'a> Device<'a> {
    pub fn new(library: &'a Library, threads: usize) -> Result<Self, DenoiseError> {
        let functions = &library.functions;
        // SAFETY: every number is allowed; without such a device, the result is null.
        let device = unsafe { (functions.oidnNewDevice)(DEVICE_TYPE_CPU) };
        let Some(device) = NonNull::new(device) else {
            return Err(error_of(functions, ptr::null_mut()));
        };
        let new = Self { functions, device };
        let threads = c_int::try_from(threads).unwrap_or(c_int::MAX);
        // SAFETY: the device is valid, and the names are strings that end with NUL. Threads must
        // not be bound to processors, because the program has others.
        unsafe {
            (functions.oidnSetDeviceInt)(device.as_ptr(), c"numThreads".as_ptr(), threads);
            (functions.oidnSetDeviceBool)(device.as_ptr(), c"setAffinity".as_ptr(), false);
            (functions.oidnCommitDevice)(device.as_ptr());
        }
        new.check()?;
        Ok(new)
    }

    /// Replaces an image, with the help of others.
    pub fn run(&self, guides: [Image; 2], replaced: Image) -> Result<(), DenoiseError> {
        // SAFETY: the device is valid, and the name is that of the filter for ray tracing.
        let filter =
            unsafe { (self.functions.oidnNewFilter)(self.device.as_ptr(), c"RT".as_ptr()) };
        self.check()?;
        let filter = Filter {
            functions: self.functions,
            filter,
        };
        for image in &guides {
            filter.set(image.name, image);
        }
        filter.set(replaced.name, &replaced);
        filter.set(c"output", &replaced);
        // SAFETY: the filter is valid. It reads and writes the images, which are borrowed until
        // the end of this function and have the stated sizes; the output may be the input.
        unsafe {
            (self.functions.oidnSetFilterBool)(filter.filter, c"hdr".as_ptr(), true);
            (self.functions.oidnCommitFilter)(filter.filter);
            (self.functions.oidnExecuteFilter)(filter.filter);
        }
        self.check()
    }

    /// The first error since the last call, if there is one.
    fn check(&self) -> Result<(), DenoiseError> {
        let mut message = ptr::null();
        // SAFETY: the device and the place for the message are valid.
        let code =
            unsafe { (self.functions.oidnGetDeviceError)(self.device.as_ptr(), &raw mut message) };
        match code {
            ERROR_NONE => Ok(()),
            _ => Err(reported(message)),
        }
    }
}

impl Drop for Device<'_> {
    fn drop(&mut self) {
        // SAFETY: the device is valid and not used any more.
        unsafe { (self.functions.oidnReleaseDevice)(self.device.as_ptr()) }
    }
}

/// A filter of a device that outlives it.
struct Filter<'a> {
    functions: &'a Functions,
    filter: *mut FilterImpl,
}

impl Filter<'_> {
    fn set(&self, name: &CStr, image: &Image) {
        let [width, height] = image.size;
        // SAFETY: the filter is valid, and the image has as many pixels of three f32 without gaps.
        unsafe {
            (self.functions.oidnSetSharedFilterImage)(
                self.filter,
                name.as_ptr(),
                image.first,
                FORMAT_FLOAT3,
                width,
                height,
                0,
                0,
                0,
            );
        }
    }
}

impl Drop for Filter<'_> {
    fn drop(&mut self) {
        // SAFETY: the filter is valid and not used any more.
        unsafe { (self.functions.oidnReleaseFilter)(self.filter) }
    }
}

/// The error of this thread, for a device that could not be made.
fn error_of(functions: &Functions, device: *mut DeviceImpl) -> DenoiseError {
    let mut message = ptr::null();
    // SAFETY: null stands for the thread, and the place for the message is valid.
    unsafe { (functions.oidnGetDeviceError)(device, &raw mut message) };
    reported(message)
}

/// An error with a message of the library, which may be null.
fn reported(message: *const c_char) -> DenoiseError {
    let message = match message.is_null() {
        true => "an error without a message".to_owned(),
        // SAFETY: a message that is not null is a string that ends with NUL, and valid until the
        // next call.
        false => unsafe { CStr::from_ptr(message) }
            .to_string_lossy()
            .into_owned(),
    };
    DenoiseError::Library { message }
}
