"""Procedural pictures, all tileable: sRGB base colours, normal maps made from heights, leaves with alpha.

Heights are in metres and pictures know how many metres they cover, so slopes are real. Row 0 is the top.
"""

import io

import numpy as np
from PIL import Image


def noise(size, falloff, seed, longest=1.0):
    """Periodic noise of zero mean and unit deviation, amplitude ~ frequency^-falloff; no wave longer than
    `longest` times the side."""
    white = np.random.default_rng(seed).standard_normal((size, size))
    frequency = np.fft.fftfreq(size, 1 / size)
    distance = np.hypot(frequency[:, None], frequency[None, :])
    gain = np.where(distance >= 1 / longest, np.maximum(distance, 1) ** -falloff, 0.0)
    values = np.real(np.fft.ifft2(np.fft.fft2(white) * gain))
    return values / values.std()


def smoothstep(low, high, x):
    t = np.clip((x - low) / (high - low), 0.0, 1.0)
    return t * t * (3 - 2 * t)


def mix(a, b, t):
    """Linear blend of colours or pictures by a mask t."""
    a, b = np.asarray(a, dtype=float), np.asarray(b, dtype=float)
    return a + (b - a) * (t[..., None] if np.ndim(t) == 2 else t)


def pixel_grid(size, metres):
    """x (to the right) and y (down) of the pixel centres in metres, as two size x size arrays."""
    centre = (np.arange(size) + 0.5) / size * metres
    return np.meshgrid(centre, centre)


def srgb_bytes(linear):
    """Linear reflectance as 8-bit sRGB."""
    c = np.clip(linear, 0.0, 1.0)
    encoded = np.where(c <= 0.0031308, 12.92 * c, 1.055 * c ** (1 / 2.4) - 0.055)
    return np.round(encoded * 255).astype(np.uint8)


def jpeg(pixels, quality=88):
    buffer = io.BytesIO()
    Image.fromarray(pixels, "RGB").save(buffer, "JPEG", quality=quality, subsampling=0, optimize=True)
    return buffer.getvalue()


def png(pixels):
    buffer = io.BytesIO()
    Image.fromarray(pixels, "RGBA").save(buffer, "PNG", optimize=True)
    return buffer.getvalue()


def normal_map(height, metres):
    """Unit normals of a height field that covers `metres` a side, +x right, +y up, as 8-bit RGB."""
    texel = metres / height.shape[0]
    right = (np.roll(height, -1, axis=1) - np.roll(height, 1, axis=1)) / (2 * texel)
    down = (np.roll(height, -1, axis=0) - np.roll(height, 1, axis=0)) / (2 * texel)
    normals = np.stack([-right, down, np.ones_like(height)], axis=2)
    normals /= np.linalg.norm(normals, axis=2, keepdims=True)
    return np.round((normals * 0.5 + 0.5) * 255).astype(np.uint8)


def stone_grain(size, seed):
    """Colour and height noise of dressed limestone: clouds, grain and a few pits."""
    clouds, grain = noise(size, 1.6, seed, 0.5), noise(size, 0.7, seed + 1, 0.1)
    pits = smoothstep(1.9, 2.8, noise(size, 0.9, seed + 2, 0.06))
    tint = 1.0 + 0.045 * clouds + 0.028 * grain - 0.16 * pits
    return tint, 0.00035 * grain + 0.0006 * clouds - 0.0018 * pits


def limestone(size=512, metres=1.2, seed=11):
    """Plain dressed stone for columns and mouldings."""
    tint, height = stone_grain(size, seed)
    warm = smoothstep(-1.0, 2.0, noise(size, 1.4, seed + 5, 0.6))
    color = mix((0.66, 0.60, 0.50), (0.62, 0.53, 0.40), warm) * tint[..., None]
    return srgb_bytes(color), normal_map(height * 0.7, metres)


def ashlar(size=1024, metres=2.4, courses=8, blocks=4, seed=21):
    """Coursed blocks of warm limestone, 0.3 m high, in running bond with drafted joints."""
    rng = np.random.default_rng(seed)
    x, y = pixel_grid(size, metres)
    row_height = metres / courses
    row = np.floor(y / row_height).astype(int) % courses
    ids, left, right = np.zeros((size, size), int), np.zeros((size, size)), np.zeros((size, size))
    for k in range(courses):
        cuts = (np.arange(blocks) + 0.5 * (k % 2) + rng.uniform(-0.16, 0.16, blocks)) * metres / blocks
        cuts = np.concatenate([cuts, [cuts[0] + metres]])
        here = row == k
        px = (x[here] - cuts[0]) % metres + cuts[0]
        block = np.searchsorted(cuts, px, side="right") - 1
        ids[here] = k * blocks + block
        left[here], right[here] = px - cuts[block], cuts[block + 1] - px
    inside = np.minimum(np.minimum(left, right), np.minimum(y % row_height, row_height - y % row_height))
    tint, height = stone_grain(size, seed + 1)
    wear = 0.0012 * noise(size, 1.0, seed + 9, 0.1)
    joint = smoothstep(0.004, 0.010, inside + wear)
    shade = rng.normal(1.0, 0.075, courses * blocks)[ids]
    hue = rng.uniform(0, 1, courses * blocks)[ids]
    color = mix((0.68, 0.60, 0.48), (0.62, 0.50, 0.36), hue) * (shade * tint)[..., None]
    color = mix((0.40, 0.35, 0.28), color, joint)
    lift = rng.normal(0.0, 0.0012, courses * blocks)[ids]
    return srgb_bytes(color), normal_map(0.006 * joint + lift * joint + height, metres)


def plaster(size=1024, metres=3.2, seed=41):
    """Old lime plaster, trowelled, with faint stains."""
    broad, fine = noise(size, 1.9, seed, 0.5), noise(size, 1.1, seed + 1, 0.08)
    stain = smoothstep(0.4, 2.6, noise(size, 1.5, seed + 2, 0.4))
    color = mix((0.75, 0.69, 0.59), (0.66, 0.55, 0.41), stain) * (1 + 0.03 * broad + 0.012 * fine)[..., None]
    return srgb_bytes(color), normal_map(0.0014 * broad * 0.8 + 0.00025 * fine, metres)


def court_paving(size=1024, metres=3.2, seed=51):
    """One bay of the court: bands of pale travertine on the column grid, within them slabs laid diagonally."""
    rng = np.random.default_rng(seed)
    x, y = pixel_grid(size, metres)
    band = 0.24
    edge = np.minimum(np.minimum(x, metres - x), np.minimum(y, metres - y))
    slab = (metres - 2 * band) / (5 * np.sqrt(2)) * 1.0
    u, v = (x - y) / np.sqrt(2) + 40 * slab, (x + y - metres) / np.sqrt(2) + 40 * slab
    cell_u, cell_v = np.floor(u / slab).astype(int), np.floor(v / slab).astype(int)
    ids = (cell_u * 131 + cell_v * 37) % 997
    near = np.minimum(np.minimum(u % slab, slab - u % slab), np.minimum(v % slab, slab - v % slab))
    along = np.where(np.minimum(x, metres - x) < np.minimum(y, metres - y), y, x)
    piece = metres / 5
    band_near = np.minimum(np.minimum(along % piece, piece - along % piece), np.abs(edge - band))
    in_band = edge < band
    joint_distance = np.where(in_band, np.minimum(band_near, edge), np.minimum(near, np.abs(edge - band)))
    tint, height = stone_grain(size, seed + 1)
    joint = smoothstep(0.003, 0.008, joint_distance + 0.001 * noise(size, 1.0, seed + 7, 0.1))
    shade = rng.normal(1.0, 0.07, 997)[ids]
    rosy = ((cell_u + cell_v) % 2 == 0).astype(float)
    inner = mix((0.64, 0.57, 0.46), (0.60, 0.43, 0.31), rosy) * shade[..., None]
    band_shade = rng.normal(1.0, 0.05, 16)[np.floor(along / piece).astype(int) % 16]
    outer = np.array([0.70, 0.65, 0.56]) * band_shade[..., None]
    color = np.where(in_band[..., None], outer, inner) * tint[..., None]
    color = mix((0.33, 0.28, 0.22), color, joint)
    lift = np.where(in_band, 0.001, rng.normal(0.0, 0.001, 997)[ids])
    return srgb_bytes(color), normal_map(0.004 * joint + lift * joint + height, metres)


def arcade_tiles(size=1024, metres=1.6, seed=61):
    """Square tiles, cream and oxblood, chequered."""
    rng = np.random.default_rng(seed)
    x, y = pixel_grid(size, metres)
    side = metres / 4
    ids = (np.floor(x / side) + 4 * np.floor(y / side)).astype(int)
    dark = (np.floor(x / side) + np.floor(y / side)).astype(int) % 2
    near = np.minimum(np.minimum(x % side, side - x % side), np.minimum(y % side, side - y % side))
    tint, height = stone_grain(size, seed + 1)
    joint = smoothstep(0.0015, 0.004, near)
    shade = rng.normal(1.0, 0.06, 16)[ids]
    color = mix((0.66, 0.59, 0.48), (0.36, 0.17, 0.11), dark.astype(float)) * (shade * tint)[..., None]
    color = mix((0.30, 0.26, 0.21), color, joint)
    return srgb_bytes(color), normal_map(0.0015 * joint + 0.4 * height, metres)


def terracotta(size=512, metres=1.0, seed=71):
    """Fired clay for pots and roof tiles."""
    tint, height = stone_grain(size, seed)
    bloom = smoothstep(0.2, 2.2, noise(size, 1.4, seed + 4, 0.5))
    color = mix((0.52, 0.24, 0.13), (0.60, 0.38, 0.26), bloom) * (1 + (tint - 1) * 1.6)[..., None]
    return srgb_bytes(color), normal_map(height, metres)


def wood(size=512, metres=1.0, planks=5, seed=81):
    """Dark oak planks, the grain along v."""
    rng = np.random.default_rng(seed)
    x, y = pixel_grid(size, metres)
    width = metres / planks
    plank = np.floor(x / width).astype(int)
    near = np.minimum(x % width, width - x % width)
    warp = noise(size, 1.8, seed + 1, 0.6)
    streak = noise(size, 0.6, seed + 2, 0.2)
    for shift in (1, 2, 4, 8, 16):  # smear the noise into fibres
        streak = (streak + np.roll(streak, shift, axis=0)) / 1.6
    rings = np.sin(2 * np.pi * (x * 46 + 0.35 * warp + rng.uniform(0, 9, planks)[plank]))
    shade = rng.normal(1.0, 0.10, planks)[plank] * (1 + 0.10 * rings + 0.05 * streak / streak.std())
    gap = smoothstep(0.001, 0.005, near)
    color = mix((0.05, 0.03, 0.02), np.array([0.27, 0.155, 0.085]) * shade[..., None], gap)
    return srgb_bytes(color), normal_map(0.003 * gap + 0.0003 * rings + 0.0002 * streak / streak.std(), metres)


def cloth(size=512, metres=0.5, seed=91):
    """Plain-woven cloth, nearly white, to be tinted; a faint damask of lozenges."""
    x, y = pixel_grid(size, metres)
    threads = 128
    weave = np.sin(2 * np.pi * threads * x / metres) * np.sin(2 * np.pi * threads * y / metres)
    lozenge = np.abs(((x / metres * 4) % 1) - 0.5) + np.abs(((y / metres * 4) % 1) - 0.5)
    figure = smoothstep(0.40, 0.44, lozenge) * (1 - smoothstep(0.56, 0.60, lozenge)) + smoothstep(0.17, 0.13, lozenge)
    slub = noise(size, 0.8, seed, 0.2)
    value = 0.86 + 0.10 * figure + 0.02 * slub + 0.02 * weave
    return srgb_bytes(np.repeat(value[..., None], 3, axis=2))


def leaves(size=512, count=34, seed=101):
    """A spray of lance-shaped leaves on a stem, growing up from the middle of the lower edge; alpha is the shape."""
    rng = np.random.default_rng(seed)
    x, y = np.meshgrid((np.arange(size) + 0.5) / size, 1 - (np.arange(size) + 0.5) / size)
    color = np.tile(np.array([0.10, 0.17, 0.05]), (size, size, 1))
    alpha = np.zeros((size, size))
    alpha[(np.abs(x - 0.5 - 0.02 * np.sin(6 * y)) < 0.007) & (y < 0.75)] = 1.0
    for k in range(count):
        t = (k + 0.5) / count
        base = np.array([0.5 + 0.02 * np.sin(4.5 * t), 0.03 + 0.69 * t])
        side = 1 if k % 2 else -1
        lean = np.radians(rng.uniform(35, 75) * (1 - 0.65 * t * t)) * side
        length = rng.uniform(0.24, 0.34) * (1 - 0.25 * t)
        axis = np.array([np.sin(lean), np.cos(lean)])
        dx, dy = x - base[0], y - base[1]
        along = (dx * axis[0] + dy * axis[1]) / length
        across = (dx * axis[1] - dy * axis[0]) / length
        half = 0.17 * np.sin(np.pi * np.clip(along, 0, 1) ** 0.8) ** 0.9
        inside = (along > 0) & (along < 1) & (np.abs(across) < half)
        rib = 1 + 0.35 * np.exp(-((across / 0.012) ** 2)) + 0.08 * np.cos(across * 120 + along * 30)
        tone = mix((0.075, 0.17, 0.035), (0.20, 0.30, 0.07), rng.uniform()) * rng.uniform(0.85, 1.15)
        color[inside] = tone[None, :] * rib[inside][:, None] * (0.85 + 0.3 * along[inside][:, None])
        alpha[inside] = 1.0
    return np.dstack([srgb_bytes(color), np.round(alpha * 255).astype(np.uint8)])
