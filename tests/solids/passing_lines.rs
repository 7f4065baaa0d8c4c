//! A line that a solid tells by a few products to pass it by has no hit: the oracle
//! of the kind, which shares no code with that, is asked about all families of cases.

use std::collections::BTreeMap;

use cyltrace::math::Ray;
use cyltrace::solid::SolidKind;
use cyltrace_oracle::cases::{AnyFamily, Case, Inputs};
use cyltrace_oracle::hits_of_any;

const SEED: u64 = 71;
const CASES: u64 = 1_000;

#[test]
fn lines_that_pass_by_have_no_hit_and_most_of_those_without_are_told() {
    // Misses, and how many of them are told, in families of rays that are aimed anywhere.
    let mut told: BTreeMap<SolidKind, [usize; 2]> = BTreeMap::new();
    for family in AnyFamily::all() {
        let name = family.name();
        for inputs in Inputs::ALL {
            for index in 0..CASES {
                let Case { solid, ray } = family.case(SEED, index, inputs);
                let line = Ray {
                    t_min: f64::NEG_INFINITY,
                    t_max: f64::INFINITY,
                    ..ray
                };
                let passes = solid.rejects(ray.origin - solid.anchor(), ray.direction);
                let is_hit = !hits_of_any(&solid, &line).is_empty();
                assert!(
                    !(passes && is_hit),
                    "{name}, seed {SEED}, {index}: {solid:?} {ray:?}"
                );
                if name.ends_with("uniform") && !is_hit {
                    let [misses, told] = told.entry(family.kind()).or_default();
                    *misses += 1;
                    *told += usize::from(passes);
                }
            }
        }
    }
    assert_eq!(told.len(), 5, "a family of each kind: {told:?}");
    for (kind, [misses, told]) in told {
        // A cone's wall goes on beyond its disks.
        assert!(4 * told > 3 * misses, "{kind:?}: {told} of {misses}");
    }
}
