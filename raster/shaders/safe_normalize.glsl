// Unit length; a degenerate vector (a zero normal in the file, a flattened instance) stays 0 and never becomes NaN.
vec3 safeNormalize(vec3 v) {
    return v * inversesqrt(max(dot(v, v), 1e-30));
}
