//! The non-manifold body: surfaces, joints, loops, chains, attributes.
