// How still pictures are shaded.
const int k_shadow_taps = 4;   // along each side of a square
const int k_contact_taps = 8;  // around a circle
const bool k_fine = true;
