//! Finds the installed Embree, generates its bindings from its own headers,
//! compiles the C shim and links the library.
//!
//! A program never uses bindings from the repository: the layout of a hit depends on how
//! the installed library was configured, and headers of another version corrupt memory
//! silently. Documentation does (`build/docs_rs.rs`), so that docs.rs needs no Embree.

#[path = "build/locate.rs"]
mod locate;

use std::env;
use std::fs;
use std::panic;
use std::path::{Path, PathBuf};
use std::process::exit;

use bindgen::callbacks::{EnumVariantCustomBehavior, EnumVariantValue, ParseCallbacks};
use locate::{Embree, VARIABLES, locate};

/// The C functions that Rust calls itself; all others stay out of the bindings.
const FUNCTIONS: &str = "cyltrace_.*|rtc(New|Release)(Device|Scene|Geometry)\
    |rtc(Attach|Commit)Geometry|rtcAttachGeometryByID|rtc(Commit|JoinCommit)Scene\
    |rtcGetSceneBounds|rtcSetSceneFlags\
    |rtcGetDevice(Property|Error)|rtcSetDevice(Error|MemoryMonitor)Function\
    |rtcSetGeometry(InstancedScene|Transform|Mask|UserData|UserPrimitiveCount)|rtcSetNewGeometryBuffer\
    |rtcSetGeometry(Bounds|Intersect|Occluded|IntersectFilter)Function";

/// The constants of C enumerations that Rust names.
const CONSTANTS: [&str; 33] = [
    "RTC_BUFFER_TYPE_FLAGS",
    "RTC_BUFFER_TYPE_INDEX",
    "RTC_BUFFER_TYPE_NORMAL",
    "RTC_BUFFER_TYPE_VERTEX",
    "RTC_DEVICE_PROPERTY_BACKFACE_CULLING_ENABLED",
    "RTC_DEVICE_PROPERTY_FILTER_FUNCTION_SUPPORTED",
    "RTC_DEVICE_PROPERTY_JOIN_COMMIT_SUPPORTED",
    "RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED",
    "RTC_DEVICE_PROPERTY_NATIVE_RAY4_SUPPORTED",
    "RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED",
    "RTC_DEVICE_PROPERTY_VERSION_MAJOR",
    "RTC_DEVICE_PROPERTY_VERSION_MINOR",
    "RTC_DEVICE_PROPERTY_VERSION_PATCH",
    "RTC_ERROR_CANCELLED",
    "RTC_ERROR_INVALID_ARGUMENT",
    "RTC_ERROR_INVALID_OPERATION",
    "RTC_ERROR_NONE",
    "RTC_ERROR_OUT_OF_MEMORY",
    "RTC_ERROR_UNSUPPORTED_CPU",
    "RTC_FORMAT_FLOAT3",
    "RTC_FORMAT_FLOAT3X4_ROW_MAJOR",
    "RTC_FORMAT_FLOAT4",
    "RTC_FORMAT_UCHAR",
    "RTC_FORMAT_UINT",
    "RTC_FORMAT_UINT3",
    "RTC_GEOMETRY_TYPE_CONE_LINEAR_CURVE",
    "RTC_GEOMETRY_TYPE_INSTANCE",
    "RTC_GEOMETRY_TYPE_ORIENTED_DISC_POINT",
    "RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE",
    "RTC_GEOMETRY_TYPE_SPHERE_POINT",
    "RTC_GEOMETRY_TYPE_TRIANGLE",
    "RTC_GEOMETRY_TYPE_USER",
    "RTC_SCENE_FLAG_ROBUST",
];

/// Bindings that are documented and never linked.
const DOCS_BINDINGS: &str = "build/docs_rs.rs";

fn main() {
    println!("cargo::rerun-if-changed=src/embree/shim.h");
    println!("cargo::rerun-if-changed=src/embree/shim.c");
    println!("cargo::rerun-if-changed=build/locate.rs");
    println!("cargo::rerun-if-env-changed=DOCS_RS");
    if env::var_os("DOCS_RS").is_some() {
        println!("cargo::rerun-if-changed={DOCS_BINDINGS}");
        fs::copy(DOCS_BINDINGS, bindings_path()).expect("the bindings for docs.rs are copied");
        return;
    }
    for variable in VARIABLES {
        println!("cargo::rerun-if-env-changed={variable}");
    }

    let arch = env::var("CARGO_CFG_TARGET_ARCH").unwrap_or_default();
    let system = ["/usr", "/usr/local", "/opt/homebrew"].map(PathBuf::from);
    let embree = match locate(|name| env::var(name).ok(), &system, &arch) {
        Ok(embree) => embree,
        Err(message) => fail(&message),
    };
    println!("cargo::rerun-if-changed={}", embree.header().display());

    bind(&embree);
    compile_c(&embree);
    link(&embree);
}

/// Prints `message` as cargo's own error and stops the build.
fn fail(message: &str) -> ! {
    for line in message.lines() {
        println!("cargo::error={line}");
    }
    // An error line is failure enough. With another exit code cargo would
    // repeat all that was printed, and the message would drown in it.
    exit(0)
}

/// Keeps only [`CONSTANTS`], so that an unused binding is a warning.
#[derive(Debug)]
struct UsedConstants;

impl ParseCallbacks for UsedConstants {
    fn enum_variant_behavior(
        &self,
        _enumeration: Option<&str>,
        constant: &str,
        _value: EnumVariantValue,
    ) -> Option<EnumVariantCustomBehavior> {
        (!CONSTANTS.contains(&constant)).then_some(EnumVariantCustomBehavior::Hide)
    }
}

/// Where `src/embree/sys.rs` includes the bindings from.
fn bindings_path() -> PathBuf {
    Path::new(&env::var("OUT_DIR").expect("cargo sets OUT_DIR")).join("embree.rs")
}

/// Writes the bindings.
fn bind(embree: &Embree) {
    let builder = bindgen::Builder::default()
        .header("src/embree/shim.h")
        .clang_arg(format!("-I{}", embree.include.display()))
        .clang_arg(format!("-DCYLTRACE_EMBREE_MAJOR={}", embree.major))
        .allowlist_function(FUNCTIONS)
        .allowlist_type("cyltrace_context|RTCRayHit(4|8|16)?|RTCBounds|RTC(Bounds|Intersect|Occluded|Filter)Function(N?)Arguments")
        .allowlist_var("RTC_VERSION_(MAJOR|MINOR|PATCH)")
        .default_enum_style(bindgen::EnumVariation::NewType {
            is_bitfield: false,
            is_global: true,
        })
        .prepend_enum_name(false)
        .parse_callbacks(Box::new(UsedConstants))
        .derive_default(true)
        .no_default(".*(Arguments|Context)|cyltrace_.*|RTC(Ray|Hit|RayHit)(4|8|16)")
        .generate_comments(false)
        .use_core();

    // bindgen panics when there is no libclang; the way out is added here.
    let generated = panic::catch_unwind(panic::AssertUnwindSafe(|| builder.generate()));
    let bindings = match generated {
        Ok(Ok(bindings)) => bindings,
        Ok(Err(error)) => fail(&format!(
            "Embree's headers in {} could not be read: {error}",
            embree.include.display()
        )),
        Err(panic) => fail(&format!(
            "bindgen could not run: {}\n\
             It needs libclang, which `sh setup.sh` installs; by hand:\n  \
             apt install libclang-dev\n  dnf install clang-devel\n  pacman -S clang\n  \
             brew install llvm\n  conda install -c conda-forge libclang\n\
             LIBCLANG_PATH names its directory when it is in an unusual place.",
            panic.downcast_ref::<String>().map_or("", String::as_str)
        )),
    };
    let target = bindings_path();
    if let Err(error) = bindings.write_to_file(&target) {
        fail(&format!("{}: {error}", target.display()));
    }
}

fn compile_c(embree: &Embree) {
    cc::Build::new()
        .file("src/embree/shim.c")
        .include(&embree.include)
        .define("CYLTRACE_EMBREE_MAJOR", embree.major.to_string().as_str())
        // A fused multiply-add would make results depend on the compiler.
        .flag_if_supported("-ffp-contract=off")
        .flag_if_supported("-std=c11")
        .warnings(true)
        .compile("cyltrace_shim");
}

fn link(embree: &Embree) {
    let loader_looks_there = ["/usr/lib", "/usr/lib64"]
        .iter()
        .any(|known| embree.library_directory.starts_with(known));
    let directory = embree.library_directory.display();
    println!("cargo::rustc-link-search=native={directory}");
    println!("cargo::rustc-link-lib={}", embree.library);
    println!("cargo::metadata=lib_dir={directory}");
    let windows = env::var("CARGO_CFG_TARGET_OS").is_ok_and(|os| os == "windows");
    if !loader_looks_there && !windows {
        println!("cargo::rustc-link-arg=-Wl,-rpath,{directory}");
        // For `build/rpath.rs`.
        println!("cargo::metadata=runtime_dir={directory}");
    }
}
