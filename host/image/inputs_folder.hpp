#pragma once
// A frame as a folder: how a renderer that is not linked to Earthshine hands over its G-buffer and its reflective
// shadow maps, and how `render --save-inputs` keeps a frame. One inputs.json and one OpenEXR file an image.
//
// Image            Key         File                  Type, channels         Space, unit
// ---------------  ----------  --------------------  ---------------------  ------------------------------------------
// albedo           albedo      albedo.exr            HALF  R G B [A]        diffuse reflectance [0; 1], linear Rec. 709
// normal           normal      normal.exr            HALF  X Y Z [valid]    unit, world space; valid 1, on sky 0
// depth            depth       depth.exr             FLOAT Z                m along the camera's -z, > 0; on sky 0
// motion           motion      motion.exr            HALF  X Y Z [W]        XY: pixels from here to the same point in
//                                                                           the previous frame, y down; Z: m, previous
//                                                                           depth minus this one. Optional: none moved
// emission         emission    emission.exr          HALF  R G B [A]        cd/m^2 added to the picture; on sky the
//                                                                           background. Optional: none
// of light i:
// RSM depth        rsmDepth    rsm_<i>_depth.exr     FLOAT Z                m along the light's -z, > 0; nothing hit: 0
// RSM normal       rsmNormal   rsm_<i>_normal.exr    HALF  X Y Z [valid]    unit, world space; valid 1, nothing hit: 0
// RSM flux         rsmFlux     rsm_<i>_flux.exr      FLOAT R G B [A]        lm: albedo x power through the texel
// shadow map       shadowDepth shadow_<i>.exr        FLOAT Z                as RSM depth, of an extent of its own
//
// Row 0 is the top. The images of the camera are of one extent, the RSMs of all lights of one, the shadow maps of one.
// Files from elsewhere may use HALF for FLOAT and FLOAT for HALF, R G B for X Y Z and the other way, may leave out what
// stands in brackets (A is then 1, W 0, and valid follows from the depth), call the fourth channel A, W or valid, and
// have a depth's only channel named anything. Every number must be finite.
//
// inputs.json:
//   {"format": "earthshine-inputs", "version": 1,
//    "camera": {"viewFromWorld": [16 numbers], "clipFromView": [16 numbers]},
//    "images": {"albedo": "albedo.exr", "normal": ..., "depth": ..., "motion": ..., "emission": ...},
//    "lights": [{"name": "sun", "type": "directional" or "spot", "intensity": [r, g, b],
//                "innerConeAngle": rad, "outerConeAngle": rad, "rangeM": m,
//                "indirectScale": factor, "gatherRadiusUv": fraction of the RSM's side,
//                "camera": {"viewFromWorld": ..., "clipFromView": ...},
//                "rsmDepth": "rsm_0_depth.exr", "rsmNormal": ..., "rsmFlux": ..., "shadowDepth": ...}]}
// Matrices are column by column (the translation is numbers 13 to 15), multiply column vectors, and follow frame.hpp:
// view space is right-handed and looks along -z, NDC is OpenGL's (y up, z in [-1; 1]). viewFromWorld is rigid.
// Intensity is in lux (directional, with an orthographic projection) or candela (spot, with a perspective one; the
// three numbers of its cone and range, as in KHR_lights_punctual, may be left out elsewhere). indirectScale and
// gatherRadiusUv may be left out: 1 and 0. "comment" may stand anywhere; any other key is an error, and so is a file
// outside the folder.

#include <filesystem>

#include "earthshine/frame.hpp"
#include "earthshine/pipeline.hpp"

namespace earthshine {

/// The file that makes a folder a folder of inputs.
inline constexpr const char* kInputsFile = "inputs.json";

/// Writes the files above into `folder`, which must be there. Throws Error if one cannot be written, UsageError if the
/// frame's lights and maps are not parallel or an image that is not optional is empty.
void writeInputs(const std::filesystem::path& folder, const FrameInputs& frame);

/// writeInputs, but the folder appears whole or not at all; an earlier folder of inputs there is replaced. Throws as
/// writeInputs and OutputSet::addFolder.
void saveInputs(const std::filesystem::path& folder, const FrameInputs& frame);

/// Reads a folder of inputs; what saveInputs wrote comes back bit for bit.
/// Throws InputError naming the file and the key or pixel for whatever is not as described above.
FrameImages loadInputs(const std::filesystem::path& folder);

}  // namespace earthshine
