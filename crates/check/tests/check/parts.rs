//! Ranges of the rays, saved and put together: the outcome of all rays at once, with its wrong
//! answers in the same order.

use std::ops::ControlFlow;
use std::sync::Arc;

use cyltrace::math::Ray;
use cyltrace::tracer::Tracer;
use cyltrace_check::{
    Class, Intersector, Outcome, PartialOutcome, ReportedHit, Settings, compare, compare_rays,
};

use crate::scenes::random_scene;
use crate::tracer;

/// Loses every hit whose distance ends in some digit.
struct Forgetful(Tracer);

impl Intersector for Forgetful {
    fn closest(&self, ray: &Ray) -> Option<ReportedHit> {
        let hit = Intersector::closest(&self.0, ray);
        hit.filter(|hit| hit.t.to_bits() % 7 != 0)
    }
}

#[test]
fn outcome_of_parts_is_that_of_all_rays() {
    let scene = Arc::new(random_scene(3));
    let wrong = Forgetful(tracer(&scene));
    let go_on = |_, _| ControlFlow::Continue(());
    for max_memory in [4 << 30, 1 << 20] {
        let settings = Settings {
            rays: 2_345,
            segments: vec![8, 24],
            classes: vec![Class::Sphere, Class::Inside],
            max_memory,
            // Fewer than a part finds, so that parts compete for the list.
            most_listed: 5,
            ..Settings::default()
        };
        let whole = compare(&scene, &wrong, &settings).expect("an outcome");
        assert!(whole.violation_count() > 100, "{whole:?}");
        assert_eq!(whole.windows.len() > 1, max_memory == 1 << 20, "{whole:?}");
        for borders in [
            &[0, 2_345][..],
            &[0, 1, 999, 1_000, 1_001, 2_345],
            &[0, 1_500, 1_500, 2_345],
        ] {
            let parts = borders.windows(2).map(|border| {
                let range = border[0]..border[1];
                let part = compare_rays(&scene, &wrong, &settings, range, &go_on);
                let bytes = part.expect("an outcome").to_bytes();
                PartialOutcome::from_bytes(&settings, &bytes).expect("the same settings")
            });
            let put_together = Outcome::of_parts(&settings, parts);
            // Debug prints every digit of a number.
            assert_eq!(
                format!("{put_together:?}"),
                format!("{whole:?}"),
                "{borders:?}"
            );
        }
    }
}

#[test]
fn tallies_of_other_settings_are_refused() {
    let scene = Arc::new(random_scene(3));
    let settings = Settings {
        rays: 100,
        ..Settings::default()
    };
    let go_on = |_, _| ControlFlow::Continue(());
    let part = compare_rays(&scene, &tracer(&scene), &settings, 0..100, &go_on);
    let bytes = part.expect("an outcome").to_bytes();
    let fewer = Settings {
        segments: vec![16],
        ..settings.clone()
    };
    assert!(PartialOutcome::from_bytes(&fewer, &bytes).is_err());
    let more = Settings {
        segments: vec![16, 32, 64],
        ..settings.clone()
    };
    assert!(PartialOutcome::from_bytes(&more, &bytes).is_err());
    for cut in 0..bytes.len() {
        assert!(
            PartialOutcome::from_bytes(&settings, &bytes[..cut]).is_err(),
            "{cut}"
        );
    }
}
