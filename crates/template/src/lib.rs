//! Feature templates: encoding, profiles, shape construction, collision, regeneration.
