"""The reflectance spectra of the Cornell box and what they are in linear Rec. 709.

Spectra: Cornell Program of Computer Graphics, "Cornell Box Data", section 2, 400 to 700 nm in steps of 4 nm.
Illuminant: CIE D65 (ISO 11664-2), 10 nm table. Colour matching functions: the fit of Wyman, Sloan and Shirley,
"Simple Analytic Approximations to the CIE XYZ Color Matching Functions", JCGT 2(2), 2013. The result is divided by
that of a perfect white reflector under the same light, so that reflectance 1 at every wavelength is exactly (1, 1, 1).
"""

import numpy as np

WAVELENGTHS = np.arange(400.0, 700.1, 4.0)

WHITE = np.array([
    0.343, 0.445, 0.551, 0.624, 0.665, 0.687, 0.708, 0.723, 0.715, 0.710, 0.745, 0.758, 0.739, 0.767, 0.777, 0.765,
    0.751, 0.745, 0.748, 0.729, 0.745, 0.757, 0.753, 0.750, 0.746, 0.747, 0.735, 0.732, 0.739, 0.734, 0.725, 0.721,
    0.733, 0.725, 0.732, 0.743, 0.744, 0.748, 0.728, 0.716, 0.733, 0.726, 0.713, 0.740, 0.754, 0.764, 0.752, 0.736,
    0.734, 0.741, 0.740, 0.732, 0.745, 0.755, 0.751, 0.744, 0.731, 0.733, 0.744, 0.731, 0.712, 0.708, 0.729, 0.730,
    0.727, 0.707, 0.703, 0.729, 0.750, 0.760, 0.751, 0.739, 0.724, 0.730, 0.740, 0.737])

GREEN = np.array([
    0.092, 0.096, 0.098, 0.097, 0.098, 0.095, 0.095, 0.097, 0.095, 0.094, 0.097, 0.098, 0.096, 0.101, 0.103, 0.104,
    0.107, 0.109, 0.112, 0.115, 0.125, 0.140, 0.160, 0.187, 0.229, 0.285, 0.343, 0.390, 0.435, 0.464, 0.472, 0.476,
    0.481, 0.462, 0.447, 0.441, 0.426, 0.406, 0.373, 0.347, 0.337, 0.314, 0.285, 0.277, 0.266, 0.250, 0.230, 0.207,
    0.186, 0.171, 0.160, 0.148, 0.141, 0.136, 0.130, 0.126, 0.123, 0.121, 0.122, 0.119, 0.114, 0.115, 0.117, 0.117,
    0.118, 0.120, 0.122, 0.128, 0.132, 0.139, 0.144, 0.146, 0.150, 0.152, 0.157, 0.159])

RED = np.array([
    0.040, 0.046, 0.048, 0.053, 0.049, 0.050, 0.053, 0.055, 0.057, 0.056, 0.059, 0.057, 0.061, 0.061, 0.060, 0.062,
    0.062, 0.062, 0.061, 0.062, 0.060, 0.059, 0.057, 0.058, 0.058, 0.058, 0.056, 0.055, 0.056, 0.059, 0.057, 0.055,
    0.059, 0.059, 0.058, 0.059, 0.061, 0.061, 0.063, 0.063, 0.067, 0.068, 0.072, 0.080, 0.090, 0.099, 0.124, 0.154,
    0.192, 0.255, 0.287, 0.349, 0.402, 0.443, 0.487, 0.513, 0.558, 0.584, 0.620, 0.606, 0.609, 0.651, 0.612, 0.610,
    0.650, 0.638, 0.627, 0.620, 0.630, 0.628, 0.642, 0.639, 0.657, 0.639, 0.635, 0.642])

D65_WAVELENGTHS = np.arange(400.0, 700.1, 10.0)
D65 = np.array([
    82.7549, 91.4860, 93.4318, 86.6823, 104.865, 117.008, 117.812, 114.861, 115.923, 108.811, 109.354, 107.802,
    104.790, 107.689, 104.405, 104.046, 100.000, 96.3342, 95.7880, 88.6856, 90.0062, 89.5991, 87.6987, 83.2886,
    83.6992, 80.0268, 80.2146, 82.2778, 78.2842, 69.7213, 71.6091])

REC709_FROM_XYZ = np.array([
    [3.2404542, -1.5371385, -0.4985314],
    [-0.9692660, 1.8760108, 0.0415560],
    [0.0556434, -0.2040259, 1.0572252]])


def _lobe(wavelengths, height, centre, below, above):
    t = (wavelengths - centre) * np.where(wavelengths < centre, below, above)
    return height * np.exp(-0.5 * t * t)


def color_matching(wavelengths):
    """x, y and z of the CIE 1931 observer (rows), the multi-lobe fit of Wyman et al., listing 1."""
    w = wavelengths
    return np.stack([
        _lobe(w, 0.362, 442.0, 0.0624, 0.0374) + _lobe(w, 1.056, 599.8, 0.0264, 0.0323)
        + _lobe(w, -0.065, 501.1, 0.0490, 0.0382),
        _lobe(w, 0.821, 568.8, 0.0213, 0.0247) + _lobe(w, 0.286, 530.9, 0.0613, 0.0322),
        _lobe(w, 1.217, 437.0, 0.0845, 0.0278) + _lobe(w, 0.681, 459.0, 0.0385, 0.0725)])


def linear_rec709(reflectance):
    """The linear Rec. 709 colour of a reflectance spectrum (sampled at WAVELENGTHS) under D65, as three floats."""
    weights = color_matching(WAVELENGTHS) * np.interp(WAVELENGTHS, D65_WAVELENGTHS, D65)
    color = REC709_FROM_XYZ @ (weights @ reflectance)
    perfect_white = REC709_FROM_XYZ @ weights.sum(axis=1)
    return [round(float(c), 6) for c in color / perfect_white]
