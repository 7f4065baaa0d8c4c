//! The program as users run it.

mod arguments;
mod bad_input;
mod bench;
mod channels;
mod check;
mod check_meshes;
mod denoise;
mod exact;
mod frames;
mod fuzz_corpus;
mod hit_rows;
mod info;
mod limits;
mod manual;
mod memory;
mod outputs;
mod parts;
mod points;
mod program;
mod render;
mod signals;
mod stress;
mod tables;
mod tessellate;
mod tessellated_scenes;
mod trace;
