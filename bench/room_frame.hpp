#pragma once
// A frame to measure on that needs no GL: a camera and a sun inside a box room, cast ray by ray on the host.

#include "earthshine/pipeline.hpp"

namespace earthshine::bench {

/// A room of 8 x 4 x 6 m open to a slanted sun, with blocks in it so that neighbours differ as in a real frame:
/// G-buffer of `extent`, one directional light with an RSM of rsmSizePx and a shadow map of twice that.
FrameImages makeRoomFrame(Extent extent, int rsmSizePx);

/// The same, kept for as long as the program runs: rows share it.
const FrameImages& roomFrame(Extent extent, int rsmSizePx);

}  // namespace earthshine::bench
