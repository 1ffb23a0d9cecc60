// What shadows may fall on.
const bool k_shaded = true;
