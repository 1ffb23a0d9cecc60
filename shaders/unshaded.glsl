// What no shadow can fall on.
const bool k_shaded = false;
