//! Models: what a file says and what is wrong with it, how models are written, and which of them describe one robot.

mod diagnostics;
mod equivalent_trees;
mod lints;
mod loading;
mod locking;
mod mutations;
mod standard_dh;
mod writing;
