//! Refinement: what is starred tiles what was there, exactly.
