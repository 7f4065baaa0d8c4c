//! Formulations against textbook answers, exact arithmetic and their known
//! failures.
