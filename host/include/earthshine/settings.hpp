#pragma once
// Every setting of the OpenCL half: one home, one default, one line of help. The command line, the report and the
// range check all walk forEachSetting(), so that an option and a key of the report have one name.

#include <span>

namespace earthshine {

/// How the sum over RSM texels, E = sum_p Phi_p / pi * G(p, x), is estimated. The disk's mean is that sum if the disk
/// covers the map (radius sqrt(2)); a smaller one leaves out what lies beyond it.
enum class Estimator {
    Disk,  ///< a few texels in a disk around the point's own projection (Dachsbacher & Stamminger 2005)
    Sum,   ///< every texel: slow, exact
};
inline constexpr const char* kEstimatorNames[] = {"disk", "sum"};

/// Where the disk's samples lie before noise moves them.
enum class DiskPattern {
    Hammersley,  ///< all over the disk
    Line,        ///< all along one radius: less work for a cache, more noise; only turned pixels' mean covers the disk
};
inline constexpr const char* kDiskPatternNames[] = {"hammersley", "line"};

/// How each pixel moves the pattern.
enum class Rotation {
    Off,    ///< not at all: bands, no noise. With animatesNoise frames turn all pixels alike, which antiLag takes for a
            ///< change of light in every frame: turn one of them off
    Noise,  ///< blue noise turns and shifts it
    Tile,   ///< by one of 16 angles, the same every 4 x 4 pixels; then the mean over as many, as far as they are one
            ///< surface: no noise. Pixels that Upsampling::Interpolate gathers in full stay unaveraged; frames turn all
            ///< pixels alike, which antiLag takes for a little change of light
    Coherent,  ///< in sets: every fourth of 64 pixels of a row reads the same texels, around any of them. About half
               ///< the time a sample on CPUs; but a set's noise is alike, and what remains of it after a filter about
               ///< doubles. Not with Upsampling::Interpolate, whose pixels are no sets
};
inline constexpr const char* kRotationNames[] = {"off", "noise", "tile", "coherent"};

/// How the disk's samples are spread over radii, each by its own pdf, so that the mean is the same.
enum class RadiusMapping {
    Area,     ///< uniform by area
    Polar,    ///< uniform by radius: denser towards the centre
    Squared,  ///< r = u^2: denser still
};
inline constexpr const char* kRadiusMappingNames[] = {"area", "polar", "squared"};

/// How one iteration of the spatial filter lays its taps.
enum class FilterKernel {
    Separable,  ///< five in a row, then five in a column: ten reads; edges that run aslant are kept less well
    Square3x3,  ///< nine at once
    Square5x5,  ///< twenty-five at once
};
inline constexpr const char* kFilterKernelNames[] = {"separable", "3x3", "5x5"};

/// How indirect light of a lower resolution comes to every pixel.
enum class Upsampling {
    Bilateral,    ///< a mean of neighbours that lie on the pixel's surface (Kopf et al. 2007)
    Interpolate,  ///< the same where enough of them do; elsewhere the pixel is gathered in full, without the denoiser
                  ///< (Dachsbacher & Stamminger 2005): for many samples
};
inline constexpr const char* kUpsamplingNames[] = {"bilateral", "interpolate"};

/// What tells the filter that a tap lies on another surface (kernels/atrous.cl).
enum class FilterWeights {
    Plane,  ///< its distance from the pixel's plane, against its distance along it: no matter the scene's scale. And
            ///< history counts for less the more it is turned; while it is short, lone pixels are limited (not if
            ///< feedback would remember that)
    Depth,  ///< its depth, against metres a step, and neither of these: the field's usual way, for comparison
};
inline constexpr const char* kFilterWeightsNames[] = {"plane", "depth"};

/// From scene-linear radiance to a display.
enum class ToneCurve {
    Filmic,  ///< the ACES curve as fitted by Narkowicz 2015, then sRGB
    Srgb,    ///< clip at 1, then sRGB
};
inline constexpr const char* kToneCurveNames[] = {"filmic", "srgb"};

struct Settings {
    Estimator estimator = Estimator::Disk;  ///< how indirect light is gathered
    int sampleCount = 256;                  ///< [1; 4096] - disk: RSM texels a pixel
    float radiusUv = 1.4143f;               ///< (0; 2] (fraction of the RSM's side) - disk: radius; sqrt(2) covers the
                                            ///< map from anywhere, less gives up energy for less noise
    Rotation rotation = Rotation::Noise;    ///< disk: how each pixel moves the pattern
    bool animatesNoise = true;              ///< disk: each frame moves the pattern, so that frames' mean converges; and
                                            ///< picks other texels of a minified RSM
    DiskPattern pattern = DiskPattern::Hammersley;  ///< disk: where samples lie before noise moves them
    RadiusMapping mapping = RadiusMapping::Area;    ///< disk: how samples are spread over radii
    int rsmMinify = 1;  ///< 1, 2, 4 or 8 (RSM texels a side) - this many squared become one texel of their summed
                        ///< flux, before estimators read them; needs packed records. Texels are larger discs then,
                        ///< whose light on what is near them is less (tests/README.md has numbers)
    int divisor = 1;    ///< 1, 2 or 4 - indirect light is computed at this part of width and height
    Upsampling upsampling = Upsampling::Bilateral;  ///< how it then comes to every pixel; interpolate: disk only
    bool accumulates = false;                       ///< frames are averaged over time, along motion vectors
    int historyFrames = 32;                         ///< [1; 1024] (frames) - accumulate: what history is worth at most
    float antiLag = 16.0f;       ///< 0 or [2; 256] - accumulate: history is dropped where the light changed by more
                                 ///< than sqrt of this times the noise of 16 x 16 pixels, or of 48 x 48; 0 = never.
                                 ///< Where fewer pixels than this are lit, no change is seen
    float fireflyFactor = 0.0f;  ///< 0 or [1; 1000] - accumulate: a pixel may be this much brighter than all around it
                                 ///< and its history; 0 = as bright as it is. Takes light away: 16 takes 3 % of the
                                 ///< Cornell box's at 8 samples
    int filterIterations = 0;    ///< [0; 7] - iterations of the spatial filter, each with twice the step; 0 = none
    FilterKernel filterKernel = FilterKernel::Separable;  ///< filter: the taps of one iteration
    FilterWeights filterWeights = FilterWeights::Plane;   ///< filter: what tells it that a tap is another surface's
    float filterDepth = 0.25f;  ///< [0.001; 1000] - plane: m off the plane a m aside, measured across the view, where
                                ///< history is 8 frames or longer; 8 / length times as much where it is shorter, and
                                ///< so 8 times without accumulate; depth: m a step
    float filterNormal = 0.3f;  ///< [0.05; 1000] - squared difference of unit normals at which a tap counts for
                                ///< nothing (plane) or 1/e (depth)
    float filterLuminance = 0.0f;   ///< [0; 1000] (standard deviations, about) - plane weights only: luminance
                                    ///< difference at which a tap counts for nothing; 0 = any. Keeps contrast that no
                                    ///< surface shows, and takes light away where few samples are bright (5 % at 8)
    float filterFade = 1024.0f;     ///< [1; 1024] (frames) - history longer than this weakens the filter in proportion,
                                    ///< a step of 2 px from half of it on, of 4 from a 16th, of 8 from a 32nd ...; an
                                    ///< iteration that counts for less than a tenth is left out; 1024 = never. What
                                    ///< is left of noise goes by samples: 128 / spp is about right
    int feedback = 0;               ///< [0; 7] - accumulate: history remembers what this many filter iterations make
    float shadowBiasTexels = 0.5f;  ///< [0; 16] (shadow map texels) - depth bias, constant part
    float shadowSlopeBiasTexels = 1.5f;       ///< [0; 16] (shadow map texels) - depth bias a unit of slope
    ToneCurve toneCurve = ToneCurve::Filmic;  ///< to the display
    bool autoExposure = true;                 ///< the log-average luminance of the picture becomes mid-grey (0.18)
    float exposureStops = 0.0f;  ///< [-32; 32] (stops) - times 2^x, on top of automatic exposure if that is on
};

/// What a person needs to know of one setting.
struct SettingInfo {
    const char* name;                         ///< as an option: --name; as a key of the report: name
    const char* unit;                         ///< "" if it has none
    double min, max;                          ///< numbers: the closed range
    const char* help;                         ///< one line
    std::span<const char* const> names = {};  ///< enums: the value's names in order
};

/// Calls visit(SettingInfo, value) for each setting; value is a reference to int, float, bool or an enum.
template <class SettingsT, class Visitor>
void forEachSetting(SettingsT& s, Visitor&& visit) {
    visit(SettingInfo{"estimator", "", 0, 1, "how the RSM is summed: disk (few texels) or sum (all, slow, exact)",
                      kEstimatorNames},
          s.estimator);
    visit(SettingInfo{"spp", "samples a pixel", 1, 4096, "disk: RSM texels that each pixel reads"}, s.sampleCount);
    visit(SettingInfo{"radius", "of the RSM's side", 1e-4, 2,
                      "disk: radius around the pixel's own projection; below 1.4143 far texels are left out"},
          s.radiusUv);
    visit(SettingInfo{"rotation", "", 0, 3,
                      "disk: pixels turn the pattern by blue noise, a tile of 4x4 (averaged), in sets, or not (bands)",
                      kRotationNames},
          s.rotation);
    visit(SettingInfo{"animate-noise", "", 0, 1,
                      "disk: each frame turns and shifts the pattern on, for means over frames"},
          s.animatesNoise);
    visit(SettingInfo{"pattern", "", 0, 1, "disk: samples all over it, or along one line, which pixels must turn",
                      kDiskPatternNames},
          s.pattern);
    visit(
        SettingInfo{"mapping", "", 0, 2, "disk: samples uniform by area, by radius (polar), or denser still (squared)",
                    kRadiusMappingNames},
        s.mapping);
    visit(SettingInfo{"rsm-minify", "RSM texels a side", 1, 8,
                      "blocks of this many (1, 2, 4 or 8) become one texel of their summed flux"},
          s.rsmMinify);
    visit(SettingInfo{"divisor", "", 1, 4, "indirect light at 1/N of width and height: 1, 2 or 4"}, s.divisor);
    visit(SettingInfo{"upsampling", "", 0, 1,
                      "divisor > 1: mean of neighbours on the surface, or interpolate and gather the rest",
                      kUpsamplingNames},
          s.upsampling);
    visit(SettingInfo{"accumulate", "", 0, 1, "average frames over time, along motion vectors"}, s.accumulates);
    visit(SettingInfo{"history", "frames", 1, 1024, "accumulate: what history is worth at most"}, s.historyFrames);
    visit(
        SettingInfo{"anti-lag", "", 0, 256,
                    "accumulate: drop history where light changed by more than the root of this times a tile's noise; "
                    "0 = never"},
        s.antiLag);
    visit(SettingInfo{"firefly", "", 0, 1000,
                      "accumulate: a pixel may be this much brighter than its neighbours and history; 0 = no limit"},
          s.fireflyFactor);
    visit(SettingInfo{"filter", "iterations", 0, 7, "spatial filter: iterations, each with twice the step; 0 = none"},
          s.filterIterations);
    visit(SettingInfo{"filter-kernel", "", 0, 2, "filter: taps of one iteration", kFilterKernelNames}, s.filterKernel);
    visit(SettingInfo{"filter-weights", "", 0, 1, "filter: what tells surfaces apart", kFilterWeightsNames},
          s.filterWeights);
    visit(SettingInfo{"filter-depth", "", 0.001, 1000,
                      "filter: tolerance; plane: m off the surface a m along it, depth: m a step"},
          s.filterDepth);
    visit(SettingInfo{"filter-normal", "", 0.05, 1000, "filter: tolerated squared difference of unit normals"},
          s.filterNormal);
    visit(SettingInfo{"filter-luminance", "standard deviations", 0, 1000,
                      "filter, plane: tolerated difference of luminance; 0 = any"},
          s.filterLuminance);
    visit(SettingInfo{"filter-fade", "frames", 1, 1024, "filter: history longer than this weakens it in proportion"},
          s.filterFade);
    visit(SettingInfo{"feedback", "iterations", 0, 7,
                      "accumulate: history remembers what this many filter iterations make"},
          s.feedback);
    visit(SettingInfo{"shadow-bias", "shadow map texels", 0, 16, "constant depth bias of the shadow test"},
          s.shadowBiasTexels);
    visit(SettingInfo{"shadow-slope-bias", "shadow map texels", 0, 16, "depth bias for each unit of slope"},
          s.shadowSlopeBiasTexels);
    visit(SettingInfo{"tone-curve", "", 0, 1, "filmic, or srgb (clipped)", kToneCurveNames}, s.toneCurve);
    visit(SettingInfo{"auto-exposure", "", 0, 1, "the picture's log-average luminance becomes mid-grey"},
          s.autoExposure);
    visit(SettingInfo{"exposure", "stops", -32, 32, "brighter by 2^x, on top of automatic exposure if that is on"},
          s.exposureStops);
}

/// Settings that go together; what a caller changes afterwards stays changed.
enum class Preset {
    Still,     ///< Settings(): one picture from many samples, no denoiser
    Fast,      ///< 2 samples and the cheapest kernel of the filter
    Balanced,  ///< 8 samples, history of 32 frames, four iterations of the filter
    High,      ///< 16 samples, history of 64 frames
    Baseline,  ///< the published technique's numbers (8 samples of a disk of 0.2, metres for depth, five iterations
               ///< whatever the history), to measure the others against
};
inline constexpr const char* kPresetNames[] = {"still", "fast", "balanced", "high", "baseline"};
Settings settingsOf(Preset preset);

/// Throws UsageError naming the first setting that is out of its range or not a number.
void validate(const Settings& settings);

}  // namespace earthshine
