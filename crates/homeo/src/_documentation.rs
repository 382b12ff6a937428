//! Documents whose Rust code is compiled and run with the documentation tests.

#[doc = include_str!("../../../README.md")]
mod readme {}

#[doc = include_str!("../../../CONTRIBUTING.md")]
mod contributing {}

#[doc = include_str!("../../../docs/certificate-format-v1.md")]
mod certificate_format {}

#[doc = include_str!("../../../docs/methods/foliation.md")]
mod methods_foliation {}

#[doc = include_str!("../../../docs/methods/hyperbolic.md")]
mod methods_hyperbolic {}
#[doc = include_str!("../../../docs/methods/bundles.md")]
mod methods_bundles {}

#[doc = include_str!("../../../docs/methods/complex.md")]
mod methods_complex {}

#[doc = include_str!("../../../docs/theory/balls.md")]
mod theory_balls {}

#[doc = include_str!("../../../docs/testing.md")]
mod testing {}
