//! A panic in a callback ends the process and says which callback it was.
//!
//! Each case runs in a child process: this test binary itself, told by a
//! variable which callback is to panic.

use std::env;
use std::process::Command;

use cyltrace::embree::{
    Box32, Coherence, Device, DeviceOptions, GREATEST_PACKET, PacketWidth, Ray32, RaySet, Rays32,
    Reached, SceneBuilder, UserGeometry,
};

const VARIABLE: &str = "CYLTRACE_TEST_PANICKING_CALLBACK";
const CHILD: &str = "panics::child_runs_the_callback_that_panics";

struct Panicking(String);

impl Panicking {
    fn reach(&self, callback: &str) {
        assert!(self.0 != callback, "the test's own panic");
    }
}

impl UserGeometry for Panicking {
    type Query = ();

    fn primitive_count(&self) -> u32 {
        10_000
    }

    fn bounds(&self, primitive: u32) -> Box32 {
        // Late, so that Embree's own threads have started.
        if primitive == 9_999 {
            self.reach("bounds");
        }
        let x = (primitive / 10) as f32;
        Box32 {
            lower: [x, 0.0, 0.0],
            upper: [x + 1.0, 1.0, 1.0],
        }
    }

    fn intersect(&self, _: Reached, _: &Ray32, _query: &mut ()) -> Option<f32> {
        self.reach("intersect");
        None
    }

    fn occluded(&self, _: Reached, _: &Ray32, _query: &mut ()) -> bool {
        self.reach("occluded");
        false
    }

    fn intersect_packet(
        &self,
        _: Reached,
        _rays: RaySet,
        _: &Rays32,
        _t_far: &mut [f32; GREATEST_PACKET],
        _packet: &mut (),
    ) -> RaySet {
        self.reach("intersect_packet");
        RaySet::EMPTY
    }

    fn occluded_packet(&self, _: Reached, _rays: RaySet, _: &Rays32, _packet: &mut ()) -> RaySet {
        self.reach("occluded_packet");
        RaySet::EMPTY
    }
}

/// The child's part; passes at once in a normal test run.
#[test]
fn child_runs_the_callback_that_panics() {
    let Ok(callback) = env::var(VARIABLE) else {
        return;
    };
    let device = Device::new(&DeviceOptions::default()).unwrap();
    let mut builder = SceneBuilder::new(&device).unwrap();
    builder.attach_user(Panicking(callback)).unwrap();
    let scene = builder.commit().unwrap();
    let ray = Ray32 {
        origin: [0.5, 0.5, -1.0],
        direction: [0.0, 0.0, 1.0],
        t_near: 0.0,
        t_far: f32::INFINITY,
    };
    scene.closest(&ray, &mut ());
    scene.any(&ray, &mut ());
    let rays = Rays32 {
        origin: ray.origin.map(|x| [x; _]),
        direction: ray.direction.map(|x| [x; _]),
        t_far: [ray.t_far; _],
    };
    let (width, coherence) = (PacketWidth::Eight, Coherence::Incoherent);
    scene.closest_packet(&rays, RaySet::ALL, width, coherence, &mut ());
    scene.any_packet(&rays, RaySet::ALL, width, coherence, &mut ());
}

fn run_child(callback: &str) -> (bool, String) {
    let output = Command::new(env::current_exe().unwrap())
        .args(["--exact", CHILD, "--nocapture"])
        .env(VARIABLE, callback)
        .output()
        .unwrap();
    #[cfg(unix)]
    {
        use std::os::unix::process::ExitStatusExt;
        const SIGABRT: i32 = 6;
        assert!(
            output.status.success() || output.status.signal() == Some(SIGABRT),
            "{output:?}"
        );
    }
    let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
    (output.status.success(), stderr)
}

#[test]
fn panic_in_each_callback_aborts_and_names_it() {
    for callback in [
        "bounds",
        "intersect",
        "occluded",
        "intersect_packet",
        "occluded_packet",
    ] {
        let (success, stderr) = run_child(callback);
        assert!(!success, "{callback}: the child went on");
        assert!(
            stderr.contains("the test's own panic"),
            "{callback}: {stderr}"
        );
        let name = format!("Embree's `{callback}` callback");
        assert!(stderr.contains(&name), "{callback}: {stderr}");
    }
}

#[test]
fn child_without_panic_succeeds() {
    let (success, stderr) = run_child("none");
    assert!(success, "{stderr}");
}
