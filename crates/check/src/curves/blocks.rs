//! How often Embree's cone curves agree, with the oracle as judge.
//!
//! The curves prove nothing, so a suspect becomes a violation only if the oracle
//! contradicts the answer as well. Questions to the oracle take milliseconds,
//! and a scene of long thin cylinders has many suspects, which are the curves'
//! fault: of a block of rays the first [`MOST_QUESTIONS`] are asked, and the
//! others count as not witnessed.

use super::{ConeCurves, CurveHit, Verdict};
use crate::finding::Intersector;
use crate::outcome::{Violation, Witness};
use crate::settings::Class;
use crate::tally::Tally;
use crate::verdict::truth;
use crate::verdict::verdict::Subject;

/// Suspects of a block that the oracle is asked about.
const MOST_QUESTIONS: u64 = 4;

/// Holds an intersector's answers for the rays of a class against the curves.
pub(crate) fn curve_block(
    about: &Subject,
    curves: &ConeCurves,
    intersector: &impl Intersector,
    class: Class,
    indices: impl Iterator<Item = u64>,
) -> Tally {
    let mut tally = Tally::default();
    let mut questions = 0;
    for index in indices {
        let (ray32, ray) = about.source.ray(class, index);
        let answer = intersector.closest(&ray);
        tally.count(answer.as_ref());
        let told = answer.as_ref().map(|finding| CurveHit {
            t: finding.t,
            solid: finding
                .place
                .as_ref()
                .and_then(|place| about.directory.find(place)),
        });
        match curves.compare(&ray32, told) {
            Verdict::Agrees => {
                tally.witnessed += 1;
                continue;
            }
            Verdict::Unwitnessed => {
                tally.unwitnessed += 1;
                continue;
            }
            Verdict::Suspect if questions == MOST_QUESTIONS => {
                tally.unwitnessed += 1;
                continue;
            }
            Verdict::Suspect => questions += 1,
        }
        let bounds = truth::bounds(about.window, &ray);
        let Some(wrong) = bounds.filter(|it| !truth::allows(it, &ray, answer.as_ref())) else {
            tally.triangle_errors += 1;
            continue;
        };
        tally.violations += 1;
        tally.listed.push(Violation {
            class,
            witness: Witness::ConeCurve,
            segments: None,
            index,
            ray,
            answer,
            allowed: (wrong.low, wrong.high),
            what: truth::in_words(about.window, &ray),
        });
    }
    tally
}
