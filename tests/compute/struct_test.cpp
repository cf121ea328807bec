// Structs that C++ and kernels share: same size, same offsets, and what C++ writes arrives, on every device
// (kernels/shared/; drivers do not check the size of an argument).

#include <gtest/gtest.h>

#include <cstddef>
#include <cstring>
#include <numeric>

#include "atrous_params.h"
#include "bilateral_upsample_params.h"
#include "compute/probe.hpp"
#include "direct_light_params.h"
#include "downsample_params.h"
#include "exposure_params.h"
#include "history_check_params.h"
#include "interpolate_params.h"
#include "light_params.h"
#include "modulate_params.h"
#include "pick_grid.h"
#include "rsm_choose_params.h"
#include "rsm_gather_params.h"
#include "rsm_pack_params.h"
#include "rsm_sum_params.h"
#include "surface_layout.h"
#include "temporal_params.h"
#include "tile_average_params.h"
#include "tone_map_params.h"
#include "unpack_params.h"

namespace earthshine {
namespace {

struct Line {
    const char* name;
    bool isStruct;
    std::size_t bytes;   ///< of the struct or the field
    std::size_t offset;  ///< of the field
};

constexpr Line kLines[] = {
#define ES_STRUCT(T) {#T, true, sizeof(T), 0},
#define ES_FIELD(T, F) {#T "." #F, false, sizeof(T::F), offsetof(T, F)},
#include "kernels/struct_fields.h"
#undef ES_STRUCT
#undef ES_FIELD
};

TEST(StructList, HoldsEveryField) {
    // Fields one after another without a hole, up to the struct's end: nothing is left out of the list.
    const Line* current = nullptr;
    std::size_t end = 0;
    for (const Line& line : kLines) {
        if (line.isStruct) {
            if (current) {
                EXPECT_EQ(end, current->bytes) << current->name;
            }
            current = &line;
            end = 0;
        } else {
            EXPECT_EQ(line.offset, end) << line.name;
            end += line.bytes;
        }
    }
    ASSERT_NE(current, nullptr);
    EXPECT_EQ(end, current->bytes) << current->name;
}

class SharedStructs : public testing::TestWithParam<reference::Variant> {};

TEST_P(SharedStructs, AreLaidOutAlike) {
    const Device device = test::openWithProbes(GetParam());
    Kernel kernel(device, "struct_probe");
    LightParams light{};
    std::vector<u32> words(sizeof(LightParams) / sizeof(u32));
    std::iota(words.begin(), words.end(), 0x3f800000u);
    std::memcpy(&light, words.data(), sizeof light);

    const std::size_t lineCount = std::size(kLines), wordsAt = (lineCount + 3) / 4 * 4;
    const cl::Buffer out = device.impl().makeBuffer((wordsAt + 2 * words.size()) * sizeof(u32));
    const cl::Buffer inLight = test::upload(device, std::vector<LightParams>{light});
    kernel.setParams("light", light).set("inLight", inLight).set("outNumbers", out);
    kernel.enqueueItems(1, 1);
    const std::vector<u32> numbers = test::download<u32>(device, out, wordsAt + 2 * words.size());

    for (std::size_t i = 0; i < lineCount; ++i)
        EXPECT_EQ(numbers[i], kLines[i].isStruct ? kLines[i].bytes : kLines[i].offset) << kLines[i].name;
    for (std::size_t i = 0; i < words.size(); ++i) {
        EXPECT_EQ(numbers[wordsAt + i], words[i]) << "by value, word " << i;
        EXPECT_EQ(numbers[wordsAt + words.size() + i], words[i]) << "through memory, word " << i;
    }
}

INSTANTIATE_TEST_SUITE_P(All, SharedStructs, testing::ValuesIn(reference::defaultVariants()),
                         [](const auto& variant) { return variant.param.name; });

}  // namespace
}  // namespace earthshine
