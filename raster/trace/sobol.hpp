#pragma once
// Random numbers that depend on nothing but where they are used: pixel, sample and dimension. So a picture is the same
// on any number of threads, and work can be taken up again where it was left.
//
// Points of the Sobol sequence in two dimensions, Owen-scrambled and shuffled by hashes, one sequence of its own for
// every pixel and every decision on a path: B. Burley 2020, "Practical Hash-based Owen Scrambling", JCGT 9(4); hash
// constants by N. Vegdahl 2021.

#include <cstdint>

#include <glm/vec2.hpp>

namespace earthshine::trace {

constexpr std::uint32_t reversedBits(std::uint32_t x) {
    x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
    x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
    x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
    x = ((x >> 8) & 0x00ff00ffu) | ((x & 0x00ff00ffu) << 8);
    return (x >> 16) | (x << 16);
}

/// Every bit of the result depends on every bit of both.
constexpr std::uint32_t hashed(std::uint32_t x, std::uint32_t seed) {
    x ^= seed * 0x9e3779b9u;
    x = (x ^ (x >> 16)) * 0x21f0aaadu;
    x = (x ^ (x >> 15)) * 0xd35a2d97u;
    x ^= x >> 15;
    return x ^ (seed * 0x85ebca6bu + 0x6c078965u);
}

/// Owen scrambling of a number whose bits are reversed: each bit is flipped by a hash of the bits below it.
constexpr std::uint32_t owenScrambledReversed(std::uint32_t x, std::uint32_t seed) {
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

/// The second dimension of the Sobol sequence, its bits reversed. Its matrix is Pascal's triangle modulo 2, which is
/// the product of five matrices that each add (xor) every other group of 1, 2, 4, 8 or 16 bits to its neighbour.
constexpr std::uint32_t secondSobolReversed(std::uint32_t index) {
    index ^= (index >> 1) & 0x55555555u;
    index ^= (index >> 2) & 0x33333333u;
    index ^= (index >> 4) & 0x0f0f0f0fu;
    index ^= (index >> 8) & 0x00ff00ffu;
    index ^= (index >> 16) & 0x0000ffffu;
    return index;
}

constexpr float unitFloat(std::uint32_t x) {
    return float(x >> 8) * 0x1p-24f;
}

/// The numbers of one sample of one pixel. `sequence` names the pixel (and all else that must not be alike); `index` is
/// the sample's. Every index below a power of two together are as even as can be.
class Sampler {
public:
    Sampler(std::uint32_t sequence, std::uint32_t index) : sequence_(sequence), reversedIndex_(reversedBits(index)) {}

    /// Two numbers in [0; 1) for the next decision.
    glm::vec2 next2() {
        const std::uint32_t seed = hashed(decision_++, sequence_);
        // The first dimension of the Sobol sequence is the index with its bits reversed.
        const std::uint32_t index = reversedBits(owenScrambledReversed(reversedIndex_, seed));
        return {unitFloat(reversedBits(owenScrambledReversed(index, hashed(seed, 1)))),
                unitFloat(reversedBits(owenScrambledReversed(secondSobolReversed(index), hashed(seed, 2))))};
    }

    float next1() { return next2().x; }

private:
    std::uint32_t sequence_, reversedIndex_, decision_ = 0;
};

}  // namespace earthshine::trace
