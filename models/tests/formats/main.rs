//! Files of every kind but OBJ, whose tests are beside its reader: good ones, and each mistake with its text.

mod babylon;
mod gltf;
mod rom;
mod stl;
