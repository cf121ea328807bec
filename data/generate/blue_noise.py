"""Blue noise by void and cluster (Ulichney 1993): a square tile of ranks that repeats without a seam.

Every threshold of the tile is a set of points that keep their distance from each other, so noise made from it has no low
frequencies and a small filter removes it. Two tiles from two seeds serve as two independent numbers a pixel.

    python3 data/generate/blue_noise.py      writes data/noise/blue_noise.pgm
"""

import pathlib

import numpy as np

SIZE = 64  # texels a side
SIGMA = 1.9  # texels: Ulichney's 1.5 leaves short-range clumps at this size
SEEDS = (1, 2)


def energy_kernel():
    """What one point adds to every texel of the tile, itself at (0, 0), with distances that wrap around."""
    axis = np.minimum(np.arange(SIZE), SIZE - np.arange(SIZE)).astype(np.float64)
    return np.exp(-(axis[:, None] ** 2 + axis[None, :] ** 2) / (2 * SIGMA**2))


class Points:
    """A set of texels and the energy that they spread."""

    def __init__(self):
        self.is_set = np.zeros((SIZE, SIZE), bool)
        self.energy = np.zeros((SIZE, SIZE))
        self.kernel = energy_kernel()

    def toggle(self, texel):
        sign = -1 if self.is_set[texel] else 1
        self.is_set[texel] ^= True
        self.energy += sign * np.roll(self.kernel, texel, (0, 1))

    def tightest_cluster(self):
        return np.unravel_index(np.argmax(np.where(self.is_set, self.energy, -np.inf)), self.energy.shape)

    def largest_void(self):
        return np.unravel_index(np.argmin(np.where(self.is_set, np.inf, self.energy)), self.energy.shape)


def initial_points(random):
    """A tenth of the texels, moved from the tightest cluster to the largest void until nothing moves."""
    points = Points()
    for index in random.permutation(SIZE * SIZE)[: SIZE * SIZE // 10]:
        points.toggle((index // SIZE, index % SIZE))
    while True:
        cluster = points.tightest_cluster()
        points.toggle(cluster)
        void = points.largest_void()
        points.toggle(void)
        if void == cluster:
            return points


def ranks(seed):
    """SIZE x SIZE ranks [0; SIZE^2): each threshold of them is blue."""
    first = initial_points(np.random.default_rng(seed))
    rank = np.zeros((SIZE, SIZE), np.int64)

    shrinking = Points()
    for texel in zip(*np.nonzero(first.is_set)):
        shrinking.toggle(texel)
    for value in range(int(first.is_set.sum()) - 1, -1, -1):
        texel = shrinking.tightest_cluster()
        shrinking.toggle(texel)
        rank[texel] = value

    growing = first
    for value in range(int(growing.is_set.sum()), SIZE * SIZE):
        texel = growing.largest_void()
        growing.toggle(texel)
        rank[texel] = value
    return rank


def main():
    tiles = np.concatenate([ranks(seed) for seed in SEEDS])
    path = pathlib.Path(__file__).parent.parent / "noise" / "blue_noise.pgm"
    path.parent.mkdir(exist_ok=True)
    header = f"P5\n# void and cluster, {len(SEEDS)} tiles of ranks below one another\n{SIZE} {SIZE * len(SEEDS)}\n65535\n"
    path.write_bytes(header.encode() + tiles.astype(">u2").tobytes())


if __name__ == "__main__":
    main()
