//! Tests of all readers and writers together.

mod broken;
mod corpus;
mod errors;
mod formats;
mod round_trip;
mod samples;
mod weld;
