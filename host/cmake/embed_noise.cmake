# cmake -DIN=blue_noise.pgm -DOUT=blue_noise_ranks.cpp -P embed_noise.cmake: the tiles of ranks as a C++ array.
file(READ ${IN} HEX HEX)
# The picture is the last 2 x 64 x 64 big-endian numbers of 16 bits.
string(LENGTH ${HEX} LENGTH)
math(EXPR BEGIN "${LENGTH} - 4 * 2 * 64 * 64")
string(SUBSTRING ${HEX} ${BEGIN} -1 HEX)
string(REGEX REPLACE "(....)" "0x\\1," NUMBERS "${HEX}")
file(WRITE ${OUT} "// Made by host/cmake/embed_noise.cmake.\n#include \"stages/blue_noise.hpp\"\n\nnamespace earthshine {\n\nconst std::uint16_t kBlueNoiseRanks[2 * kBlueNoiseSizePx * kBlueNoiseSizePx] = {${NUMBERS}};\n\n}  // namespace earthshine\n")
