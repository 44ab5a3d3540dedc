//! Force laws, and the joints that map coordinates to the deformations of a law; independent of bodies and
//! integrators.
//!
//! A law of a joint or a contact is one file that implements [`ForceLaw`](law::ForceLaw), and one line in the
//! list of `contract`, whose tests hold every law to the trait: stiffness, damping, derivatives with respect
//! to coefficients, power balance, equal bits in lanes. The joint between two rods in the plane is `plane`;
//! the bushing in space, with its markers, is [`bushing`].
pub mod bushing;
#[cfg(test)]
mod contract;
pub mod impact;
pub mod law;
pub mod plane;
