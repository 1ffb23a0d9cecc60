// A cabinet on points between the edges of its base beside ODE's box, step by step.
#pragma once

namespace topple::bench {

/// Prints what a step of 1 ms of either takes, by turns, and how far its peaks are off a frame's.
void run_edges();

}  // namespace topple::bench
