// Bindings to Embree 3.13 for documentation, where Embree and libclang are not installed:
// `build.rs` uses them only if DOCS_RS is set, as docs.rs does, and then links nothing.
//
// Made by bindgen through `build.rs`, without the checks of layouts. To make them anew, copy
// embree.rs from the build script's folder; tests/embree_ffi compares the names.

pub const RTC_VERSION_MAJOR: u32 = 3;
pub const RTC_VERSION_MINOR: u32 = 13;
pub const RTC_VERSION_PATCH: u32 = 5;
pub const RTC_FORMAT_UCHAR: RTCFormat = RTCFormat(4097);
pub const RTC_FORMAT_UINT: RTCFormat = RTCFormat(20481);
pub const RTC_FORMAT_UINT3: RTCFormat = RTCFormat(20483);
pub const RTC_FORMAT_FLOAT3: RTCFormat = RTCFormat(36867);
pub const RTC_FORMAT_FLOAT4: RTCFormat = RTCFormat(36868);
pub const RTC_FORMAT_FLOAT3X4_ROW_MAJOR: RTCFormat = RTCFormat(37172);
#[repr(transparent)]
#[derive(Debug, Copy, Clone, Hash, PartialEq, Eq)]
pub struct RTCFormat(pub ::core::ffi::c_uint);
#[repr(C)]
#[repr(align(16))]
#[derive(Debug, Default, Copy, Clone)]
pub struct RTCBounds {
    pub lower_x: f32,
    pub lower_y: f32,
    pub lower_z: f32,
    pub align0: f32,
    pub upper_x: f32,
    pub upper_y: f32,
    pub upper_z: f32,
    pub align1: f32,
}
#[repr(transparent)]
#[derive(Debug, Copy, Clone, Hash, PartialEq, Eq)]
pub struct RTCIntersectContextFlags(pub ::core::ffi::c_uint);
#[repr(C)]
#[derive(Debug, Copy, Clone)]
pub struct RTCFilterFunctionNArguments {
    pub valid: *mut ::core::ffi::c_int,
    pub geometryUserPtr: *mut ::core::ffi::c_void,
    pub context: *mut RTCIntersectContext,
    pub ray: *mut RTCRayN,
    pub hit: *mut RTCHitN,
    pub N: ::core::ffi::c_uint,
}
pub type RTCFilterFunctionN =
    ::core::option::Option<unsafe extern "C" fn(args: *const RTCFilterFunctionNArguments)>;
#[repr(C)]
#[derive(Debug, Copy, Clone)]
pub struct RTCIntersectContext {
    pub flags: RTCIntersectContextFlags,
    pub filter: RTCFilterFunctionN,
    pub instID: [::core::ffi::c_uint; 1usize],
}
#[repr(C)]
#[derive(Debug)]
pub struct RTCDeviceTy {
    _unused: [u8; 0],
}
pub type RTCDevice = *mut RTCDeviceTy;
unsafe extern "C" {
    pub fn rtcNewDevice(config: *const ::core::ffi::c_char) -> RTCDevice;
}
unsafe extern "C" {
    pub fn rtcReleaseDevice(device: RTCDevice);
}
pub const RTC_DEVICE_PROPERTY_VERSION_MAJOR: RTCDeviceProperty = RTCDeviceProperty(1);
pub const RTC_DEVICE_PROPERTY_VERSION_MINOR: RTCDeviceProperty = RTCDeviceProperty(2);
pub const RTC_DEVICE_PROPERTY_VERSION_PATCH: RTCDeviceProperty = RTCDeviceProperty(3);
pub const RTC_DEVICE_PROPERTY_NATIVE_RAY4_SUPPORTED: RTCDeviceProperty = RTCDeviceProperty(32);
pub const RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED: RTCDeviceProperty = RTCDeviceProperty(33);
pub const RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED: RTCDeviceProperty = RTCDeviceProperty(34);
pub const RTC_DEVICE_PROPERTY_BACKFACE_CULLING_ENABLED: RTCDeviceProperty = RTCDeviceProperty(65);
pub const RTC_DEVICE_PROPERTY_FILTER_FUNCTION_SUPPORTED: RTCDeviceProperty = RTCDeviceProperty(66);
pub const RTC_DEVICE_PROPERTY_JOIN_COMMIT_SUPPORTED: RTCDeviceProperty = RTCDeviceProperty(129);
#[repr(transparent)]
#[derive(Debug, Copy, Clone, Hash, PartialEq, Eq)]
pub struct RTCDeviceProperty(pub ::core::ffi::c_uint);
unsafe extern "C" {
    pub fn rtcGetDeviceProperty(device: RTCDevice, prop: RTCDeviceProperty) -> isize;
}
pub const RTC_ERROR_NONE: RTCError = RTCError(0);
pub const RTC_ERROR_INVALID_ARGUMENT: RTCError = RTCError(2);
pub const RTC_ERROR_INVALID_OPERATION: RTCError = RTCError(3);
pub const RTC_ERROR_OUT_OF_MEMORY: RTCError = RTCError(4);
pub const RTC_ERROR_UNSUPPORTED_CPU: RTCError = RTCError(5);
pub const RTC_ERROR_CANCELLED: RTCError = RTCError(6);
#[repr(transparent)]
#[derive(Debug, Copy, Clone, Hash, PartialEq, Eq)]
pub struct RTCError(pub ::core::ffi::c_uint);
unsafe extern "C" {
    pub fn rtcGetDeviceError(device: RTCDevice) -> RTCError;
}
pub type RTCErrorFunction = ::core::option::Option<
    unsafe extern "C" fn(
        userPtr: *mut ::core::ffi::c_void,
        code: RTCError,
        str_: *const ::core::ffi::c_char,
    ),
>;
unsafe extern "C" {
    pub fn rtcSetDeviceErrorFunction(
        device: RTCDevice,
        error: RTCErrorFunction,
        userPtr: *mut ::core::ffi::c_void,
    );
}
pub type RTCMemoryMonitorFunction = ::core::option::Option<
    unsafe extern "C" fn(ptr: *mut ::core::ffi::c_void, bytes: isize, post: bool) -> bool,
>;
unsafe extern "C" {
    pub fn rtcSetDeviceMemoryMonitorFunction(
        device: RTCDevice,
        memoryMonitor: RTCMemoryMonitorFunction,
        userPtr: *mut ::core::ffi::c_void,
    );
}
pub const RTC_BUFFER_TYPE_INDEX: RTCBufferType = RTCBufferType(0);
pub const RTC_BUFFER_TYPE_VERTEX: RTCBufferType = RTCBufferType(1);
pub const RTC_BUFFER_TYPE_NORMAL: RTCBufferType = RTCBufferType(3);
pub const RTC_BUFFER_TYPE_FLAGS: RTCBufferType = RTCBufferType(32);
#[repr(transparent)]
#[derive(Debug, Copy, Clone, Hash, PartialEq, Eq)]
pub struct RTCBufferType(pub ::core::ffi::c_uint);
#[repr(C)]
#[repr(align(16))]
#[derive(Debug, Default, Copy, Clone)]
pub struct RTCRay {
    pub org_x: f32,
    pub org_y: f32,
    pub org_z: f32,
    pub tnear: f32,
    pub dir_x: f32,
    pub dir_y: f32,
    pub dir_z: f32,
    pub time: f32,
    pub tfar: f32,
    pub mask: ::core::ffi::c_uint,
    pub id: ::core::ffi::c_uint,
    pub flags: ::core::ffi::c_uint,
}
#[repr(C)]
#[repr(align(16))]
#[derive(Debug, Default, Copy, Clone)]
pub struct RTCHit {
    pub Ng_x: f32,
    pub Ng_y: f32,
    pub Ng_z: f32,
    pub u: f32,
    pub v: f32,
    pub primID: ::core::ffi::c_uint,
    pub geomID: ::core::ffi::c_uint,
    pub instID: [::core::ffi::c_uint; 1usize],
}
#[repr(C)]
#[repr(align(16))]
#[derive(Debug, Default, Copy, Clone)]
pub struct RTCRayHit {
    pub ray: RTCRay,
    pub hit: RTCHit,
}
#[repr(C)]
#[repr(align(16))]
#[derive(Debug, Copy, Clone)]
pub struct RTCRay4 {
    pub org_x: [f32; 4usize],
    pub org_y: [f32; 4usize],
    pub org_z: [f32; 4usize],
    pub tnear: [f32; 4usize],
    pub dir_x: [f32; 4usize],
    pub dir_y: [f32; 4usize],
    pub dir_z: [f32; 4usize],
    pub time: [f32; 4usize],
    pub tfar: [f32; 4usize],
    pub mask: [::core::ffi::c_uint; 4usize],
    pub id: [::core::ffi::c_uint; 4usize],
    pub flags: [::core::ffi::c_uint; 4usize],
}
#[repr(C)]
#[repr(align(16))]
#[derive(Debug, Copy, Clone)]
pub struct RTCHit4 {
    pub Ng_x: [f32; 4usize],
    pub Ng_y: [f32; 4usize],
    pub Ng_z: [f32; 4usize],
    pub u: [f32; 4usize],
    pub v: [f32; 4usize],
    pub primID: [::core::ffi::c_uint; 4usize],
    pub geomID: [::core::ffi::c_uint; 4usize],
    pub instID: [[::core::ffi::c_uint; 4usize]; 1usize],
}
#[repr(C)]
#[repr(align(16))]
#[derive(Debug, Copy, Clone)]
pub struct RTCRayHit4 {
    pub ray: RTCRay4,
    pub hit: RTCHit4,
}
#[repr(C)]
#[repr(align(32))]
#[derive(Debug, Copy, Clone)]
pub struct RTCRay8 {
    pub org_x: [f32; 8usize],
    pub org_y: [f32; 8usize],
    pub org_z: [f32; 8usize],
    pub tnear: [f32; 8usize],
    pub dir_x: [f32; 8usize],
    pub dir_y: [f32; 8usize],
    pub dir_z: [f32; 8usize],
    pub time: [f32; 8usize],
    pub tfar: [f32; 8usize],
    pub mask: [::core::ffi::c_uint; 8usize],
    pub id: [::core::ffi::c_uint; 8usize],
    pub flags: [::core::ffi::c_uint; 8usize],
}
#[repr(C)]
#[repr(align(32))]
#[derive(Debug, Copy, Clone)]
pub struct RTCHit8 {
    pub Ng_x: [f32; 8usize],
    pub Ng_y: [f32; 8usize],
    pub Ng_z: [f32; 8usize],
    pub u: [f32; 8usize],
    pub v: [f32; 8usize],
    pub primID: [::core::ffi::c_uint; 8usize],
    pub geomID: [::core::ffi::c_uint; 8usize],
    pub instID: [[::core::ffi::c_uint; 8usize]; 1usize],
}
#[repr(C)]
#[repr(align(32))]
#[derive(Debug, Copy, Clone)]
pub struct RTCRayHit8 {
    pub ray: RTCRay8,
    pub hit: RTCHit8,
}
#[repr(C)]
#[repr(align(64))]
#[derive(Debug, Copy, Clone)]
pub struct RTCRay16 {
    pub org_x: [f32; 16usize],
    pub org_y: [f32; 16usize],
    pub org_z: [f32; 16usize],
    pub tnear: [f32; 16usize],
    pub dir_x: [f32; 16usize],
    pub dir_y: [f32; 16usize],
    pub dir_z: [f32; 16usize],
    pub time: [f32; 16usize],
    pub tfar: [f32; 16usize],
    pub mask: [::core::ffi::c_uint; 16usize],
    pub id: [::core::ffi::c_uint; 16usize],
    pub flags: [::core::ffi::c_uint; 16usize],
}
#[repr(C)]
#[repr(align(64))]
#[derive(Debug, Copy, Clone)]
pub struct RTCHit16 {
    pub Ng_x: [f32; 16usize],
    pub Ng_y: [f32; 16usize],
    pub Ng_z: [f32; 16usize],
    pub u: [f32; 16usize],
    pub v: [f32; 16usize],
    pub primID: [::core::ffi::c_uint; 16usize],
    pub geomID: [::core::ffi::c_uint; 16usize],
    pub instID: [[::core::ffi::c_uint; 16usize]; 1usize],
}
#[repr(C)]
#[repr(align(64))]
#[derive(Debug, Copy, Clone)]
pub struct RTCRayHit16 {
    pub ray: RTCRay16,
    pub hit: RTCHit16,
}
#[repr(C)]
#[derive(Debug)]
pub struct RTCRayN {
    _unused: [u8; 0],
}
#[repr(C)]
#[derive(Debug)]
pub struct RTCHitN {
    _unused: [u8; 0],
}
#[repr(C)]
#[derive(Debug)]
pub struct RTCRayHitN {
    _unused: [u8; 0],
}
#[repr(C)]
#[derive(Debug)]
pub struct RTCSceneTy {
    _unused: [u8; 0],
}
pub type RTCScene = *mut RTCSceneTy;
#[repr(C)]
#[derive(Debug)]
pub struct RTCGeometryTy {
    _unused: [u8; 0],
}
pub type RTCGeometry = *mut RTCGeometryTy;
pub const RTC_GEOMETRY_TYPE_TRIANGLE: RTCGeometryType = RTCGeometryType(0);
pub const RTC_GEOMETRY_TYPE_CONE_LINEAR_CURVE: RTCGeometryType = RTCGeometryType(15);
pub const RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE: RTCGeometryType = RTCGeometryType(16);
pub const RTC_GEOMETRY_TYPE_SPHERE_POINT: RTCGeometryType = RTCGeometryType(50);
pub const RTC_GEOMETRY_TYPE_ORIENTED_DISC_POINT: RTCGeometryType = RTCGeometryType(52);
pub const RTC_GEOMETRY_TYPE_USER: RTCGeometryType = RTCGeometryType(120);
pub const RTC_GEOMETRY_TYPE_INSTANCE: RTCGeometryType = RTCGeometryType(121);
#[repr(transparent)]
#[derive(Debug, Copy, Clone, Hash, PartialEq, Eq)]
pub struct RTCGeometryType(pub ::core::ffi::c_uint);
#[repr(C)]
#[derive(Debug, Copy, Clone)]
pub struct RTCBoundsFunctionArguments {
    pub geometryUserPtr: *mut ::core::ffi::c_void,
    pub primID: ::core::ffi::c_uint,
    pub timeStep: ::core::ffi::c_uint,
    pub bounds_o: *mut RTCBounds,
}
pub type RTCBoundsFunction =
    ::core::option::Option<unsafe extern "C" fn(args: *const RTCBoundsFunctionArguments)>;
#[repr(C)]
#[derive(Debug, Copy, Clone)]
pub struct RTCIntersectFunctionNArguments {
    pub valid: *mut ::core::ffi::c_int,
    pub geometryUserPtr: *mut ::core::ffi::c_void,
    pub primID: ::core::ffi::c_uint,
    pub context: *mut RTCIntersectContext,
    pub rayhit: *mut RTCRayHitN,
    pub N: ::core::ffi::c_uint,
    pub geomID: ::core::ffi::c_uint,
}
pub type RTCIntersectFunctionN =
    ::core::option::Option<unsafe extern "C" fn(args: *const RTCIntersectFunctionNArguments)>;
#[repr(C)]
#[derive(Debug, Copy, Clone)]
pub struct RTCOccludedFunctionNArguments {
    pub valid: *mut ::core::ffi::c_int,
    pub geometryUserPtr: *mut ::core::ffi::c_void,
    pub primID: ::core::ffi::c_uint,
    pub context: *mut RTCIntersectContext,
    pub ray: *mut RTCRayN,
    pub N: ::core::ffi::c_uint,
    pub geomID: ::core::ffi::c_uint,
}
pub type RTCOccludedFunctionN =
    ::core::option::Option<unsafe extern "C" fn(args: *const RTCOccludedFunctionNArguments)>;
unsafe extern "C" {
    pub fn rtcNewGeometry(device: RTCDevice, type_: RTCGeometryType) -> RTCGeometry;
}
unsafe extern "C" {
    pub fn rtcReleaseGeometry(geometry: RTCGeometry);
}
unsafe extern "C" {
    pub fn rtcCommitGeometry(geometry: RTCGeometry);
}
unsafe extern "C" {
    pub fn rtcSetGeometryMask(geometry: RTCGeometry, mask: ::core::ffi::c_uint);
}
unsafe extern "C" {
    pub fn rtcSetNewGeometryBuffer(
        geometry: RTCGeometry,
        type_: RTCBufferType,
        slot: ::core::ffi::c_uint,
        format: RTCFormat,
        byteStride: usize,
        itemCount: usize,
    ) -> *mut ::core::ffi::c_void;
}
unsafe extern "C" {
    pub fn rtcSetGeometryIntersectFilterFunction(geometry: RTCGeometry, filter: RTCFilterFunctionN);
}
unsafe extern "C" {
    pub fn rtcSetGeometryUserData(geometry: RTCGeometry, ptr: *mut ::core::ffi::c_void);
}
unsafe extern "C" {
    pub fn rtcSetGeometryUserPrimitiveCount(
        geometry: RTCGeometry,
        userPrimitiveCount: ::core::ffi::c_uint,
    );
}
unsafe extern "C" {
    pub fn rtcSetGeometryBoundsFunction(
        geometry: RTCGeometry,
        bounds: RTCBoundsFunction,
        userPtr: *mut ::core::ffi::c_void,
    );
}
unsafe extern "C" {
    pub fn rtcSetGeometryIntersectFunction(geometry: RTCGeometry, intersect: RTCIntersectFunctionN);
}
unsafe extern "C" {
    pub fn rtcSetGeometryOccludedFunction(geometry: RTCGeometry, occluded: RTCOccludedFunctionN);
}
unsafe extern "C" {
    pub fn rtcSetGeometryInstancedScene(geometry: RTCGeometry, scene: RTCScene);
}
unsafe extern "C" {
    pub fn rtcSetGeometryTransform(
        geometry: RTCGeometry,
        timeStep: ::core::ffi::c_uint,
        format: RTCFormat,
        xfm: *const ::core::ffi::c_void,
    );
}
pub const RTC_SCENE_FLAG_ROBUST: RTCSceneFlags = RTCSceneFlags(4);
#[repr(transparent)]
#[derive(Debug, Copy, Clone, Hash, PartialEq, Eq)]
pub struct RTCSceneFlags(pub ::core::ffi::c_uint);
unsafe extern "C" {
    pub fn rtcNewScene(device: RTCDevice) -> RTCScene;
}
unsafe extern "C" {
    pub fn rtcReleaseScene(scene: RTCScene);
}
unsafe extern "C" {
    pub fn rtcAttachGeometry(scene: RTCScene, geometry: RTCGeometry) -> ::core::ffi::c_uint;
}
unsafe extern "C" {
    pub fn rtcAttachGeometryByID(
        scene: RTCScene,
        geometry: RTCGeometry,
        geomID: ::core::ffi::c_uint,
    );
}
unsafe extern "C" {
    pub fn rtcCommitScene(scene: RTCScene);
}
unsafe extern "C" {
    pub fn rtcJoinCommitScene(scene: RTCScene);
}
unsafe extern "C" {
    pub fn rtcSetSceneFlags(scene: RTCScene, flags: RTCSceneFlags);
}
unsafe extern "C" {
    pub fn rtcGetSceneBounds(scene: RTCScene, bounds_o: *mut RTCBounds);
}
pub type cyltrace_embree_context = RTCIntersectContext;
#[repr(C)]
#[derive(Debug, Copy, Clone)]
pub struct cyltrace_context {
    pub embree: cyltrace_embree_context,
    pub query: *mut ::core::ffi::c_void,
    pub is_packet: bool,
}
unsafe extern "C" {
    pub fn cyltrace_intersect1(
        scene: RTCScene,
        rayhit: *mut RTCRayHit,
        query: *mut ::core::ffi::c_void,
    );
}
unsafe extern "C" {
    pub fn cyltrace_occluded1(scene: RTCScene, ray: *mut RTCRay, query: *mut ::core::ffi::c_void);
}
unsafe extern "C" {
    pub fn cyltrace_intersect_packet(
        width: ::core::ffi::c_uint,
        valid: *const ::core::ffi::c_int,
        scene: RTCScene,
        rayhits: *mut ::core::ffi::c_void,
        query: *mut ::core::ffi::c_void,
        coherent: bool,
    );
}
unsafe extern "C" {
    pub fn cyltrace_occluded_packet(
        width: ::core::ffi::c_uint,
        valid: *const ::core::ffi::c_int,
        scene: RTCScene,
        rays: *mut ::core::ffi::c_void,
        query: *mut ::core::ffi::c_void,
        coherent: bool,
    );
}
unsafe extern "C" {
    pub fn cyltrace_enter_default_float_mode() -> u64;
}
unsafe extern "C" {
    pub fn cyltrace_enter_flushing_float_mode() -> u64;
}
unsafe extern "C" {
    pub fn cyltrace_restore_float_mode(former: u64);
}
