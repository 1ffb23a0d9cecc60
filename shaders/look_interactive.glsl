// How pictures are shaded that a person waits for: on a software rasteriser, what most pixels need is
// what counts.
const int k_shadow_taps = 2;   // along each side of a square
const int k_contact_taps = 4;  // around a circle
const bool k_fine = false;
