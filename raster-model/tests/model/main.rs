//! The model from outside: streams of words in; pixels, depths, registers and counters out.

mod lent;
mod reference;
mod registers;
mod rng;
mod setup;
mod stream;
mod triangles;
