//! Certified bijective maps between shapes.
//!
//! The folders follow the data: a mesh comes in ([`input`]), is refined where a construction needs it
//! ([`refine`]), a construction finds the map ([`construct`]), the map is evaluated both ways ([`map`]),
//! compared and used ([`overlay`], [`transfer`], [`warp`]), written with its certificate ([`certificate`]) and shown ([`export`]).
//! Shapes between two polygons or curves are in [`shape`], harmonic functions of planar domains in [`harmonic`],
//! complex maps with speeds along edges in [`complex`], meshes that move with a cage in [`cage`].
//! What is proved about a map is re-established by the separate checker `homeo-verify`.

pub mod cage;
pub mod certificate;
pub mod complex;
pub mod composite;
pub mod construct;
pub mod coordinates;
pub mod export;
#[cfg(feature = "gpu")]
pub mod gpu;
pub mod harmonic;
pub mod input;
pub mod linear;
pub mod map;
pub mod overlay;
pub mod progress;
pub mod refine;
pub mod shape;
pub mod transfer;
pub mod warp;

#[cfg(doctest)]
mod _documentation;
