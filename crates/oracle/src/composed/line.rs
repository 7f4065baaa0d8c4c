//! What a line has in common with a composition.
//!
//! The parameters at which the line is on a sheet that decides about its leaf cut it
//! into stretches. A stretch is where its middle is: inside, outside or in the boundary,
//! as `around.rs` finds out. What is at its ends follows likewise. With the definition
//! of hits in `mod.rs` this is all.

use std::cmp::Ordering;

use crate::number::{Exact, ExactVector, Surd, exact, long, sign, to_f64, zero};
use crate::taper::Quadratic;
use cyltrace::solid::Location;

use super::ComposedTruth;
use super::around::Around;
use super::place::Place;

/// Below this share of what is added, the sign of a sum of f64 is not trusted.
const UNSURE: f64 = 1e-12;

/// A sheet along the line: exactly, and in f64.
struct Along {
    exact: Quadratic,
    rough: [f64; 3],
}

/// A parameter and its nearest f64.
#[derive(Clone)]
pub(super) struct Parameter {
    pub t: Surd,
    pub rough: f64,
}

/// A point where something may change, and the stretch behind it.
pub(super) struct Station {
    pub at: Parameter,
    pub here: Around,
    pub behind: Around,
}

impl Along {
    /// The sign at a parameter `(p + q √s) / r`.
    fn sign_at(&self, at: &Parameter) -> Ordering {
        let [a, b, c] = self.rough;
        let terms = [a * at.rough * at.rough, 2.0 * b * at.rough, c];
        let sum = terms[0] + terms[1] + terms[2];
        let size: f64 = terms.iter().map(|term| term.abs()).sum();
        if sum.abs() > UNSURE * size && size > 1e-200 && size < 1e200 {
            return sum.total_cmp(&0.0);
        }
        let Quadratic { a, b, c } = &self.exact;
        let Surd { p, q, s, r } = &at.t;
        let two = exact(2.0);
        let rational = a * (p * p + q * q * s) + &two * b * r * p + c * r * r;
        let with_root = &two * a * p * q + &two * b * r * q;
        super::super::number::sign_with_root(&rational, &with_root, s)
    }
}

impl Parameter {
    pub fn new(t: Surd) -> Self {
        Self {
            rough: to_f64(&t.value()),
            t,
        }
    }

    pub fn order(&self, other: &Self) -> Ordering {
        let apart = self.rough - other.rough;
        if apart.abs() > UNSURE * (self.rough.abs() + other.rough.abs()) {
            return apart.total_cmp(&0.0);
        }
        self.t.cmp_exact(&other.t)
    }

    /// A number between two.
    fn between(&self, other: &Self) -> Self {
        let middle = 0.5 * self.rough + 0.5 * other.rough;
        let is_between = self.t.cmp_f64(middle) == Ordering::Less
            && other.t.cmp_f64(middle) == Ordering::Greater;
        if is_between {
            return Self {
                t: Surd::whole(exact(middle)),
                rough: middle,
            };
        }
        let sum: Exact = long(&(self.t.value() + other.t.value()));
        Self::new(Surd::whole((sum * exact(0.5)).with_precision(0).value()))
    }
}

/// The stations of a line, in order. Before the first and behind the last it is outside.
pub(super) fn stations(
    truth: &ComposedTruth,
    origin: &ExactVector,
    direction: &ExactVector,
) -> Vec<Station> {
    let along: Vec<Vec<Along>> = truth
        .leaves
        .iter()
        .map(|leaf| {
            let sheets = leaf.sheets.iter().map(|sheet| {
                let exact = sheet.on_line(origin, direction);
                let rough = [&exact.a, &exact.b, &exact.c].map(to_f64);
                Along { exact, rough }
            });
            sheets.collect()
        })
        .collect();
    let signs_at = |at: &Parameter| -> Vec<Vec<Ordering>> {
        let signs = |sheets: &Vec<Along>| sheets.iter().map(|one| one.sign_at(at)).collect();
        along.iter().map(signs).collect()
    };
    let around = |at: &Parameter| {
        let place = Place::on_line(origin, direction, &at.t);
        Around::with_signs(&truth.composition, &truth.leaves, signs_at(at), &place)
    };

    let mut parameters: Vec<Parameter> = Vec::new();
    for (leaf, sheets) in truth.leaves.iter().zip(&along) {
        for sheet in sheets {
            let roots = roots_of(&sheet.exact).into_iter().map(Parameter::new);
            parameters.extend(roots.filter(|at| {
                let signs: Vec<_> = sheets.iter().map(|one| one.sign_at(at)).collect();
                leaf.decide(&signs).is_none()
            }));
        }
    }
    parameters.sort_by(Parameter::order);
    parameters.dedup_by(|one, other| one.order(other) == Ordering::Equal);

    let mut stations = Vec::new();
    for (position, at) in parameters.iter().enumerate() {
        let behind = match parameters.get(position + 1) {
            Some(next) => around(&at.between(next)),
            None => Around {
                location: Location::Outside,
                faces: Vec::new(),
            },
        };
        stations.push(Station {
            here: around(at),
            behind,
            at: at.clone(),
        });
    }
    stations
}

/// The zeros of a sheet on the line; none if it is zero everywhere.
fn roots_of(quadratic: &Quadratic) -> Vec<Surd> {
    let s = quadratic.discriminant();
    if sign(&s) == Ordering::Equal && sign(&quadratic.a) != Ordering::Equal {
        // Touched: the root is a quotient.
        return vec![Surd::quotient(-&quadratic.b, quadratic.a.clone())];
    }
    let mut roots = quadratic.roots();
    for root in &mut roots {
        if sign(&root.q) == Ordering::Equal {
            root.s = zero();
        }
    }
    roots
}
