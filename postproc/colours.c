/* See colours.h. */
#include "colours.h"

struct colours_rgb colours_of_share(double share)
{
    enum { N = 9 };
    static const struct colours_rgb stops[N] = {
        {0.375f, 0.190f, 0.530f}, {0.330f, 0.290f, 0.620f}, {0.255f, 0.370f, 0.615f},
        {0.190f, 0.490f, 0.620f}, {0.140f, 0.600f, 0.590f}, {0.180f, 0.705f, 0.525f},
        {0.363f, 0.785f, 0.387f}, {0.667f, 0.862f, 0.196f}, {0.993f, 0.906f, 0.144f},
    };
    const double clipped = share > 0.0 ? (share < 1.0 ? share : 1.0) : 0.0;
    const int i = clipped < 1.0 ? (int)(clipped * (N - 1)) : N - 2;
    const float f = (float)(clipped * (N - 1) - i);
    const struct colours_rgb a = stops[i], b = stops[i + 1];
    return (struct colours_rgb){a.r + f * (b.r - a.r), a.g + f * (b.g - a.g),
                                a.b + f * (b.b - a.b)};
}

struct colours_rgb colours_of_kind(int kind)
{
    static const struct colours_rgb kinds[COLOURS_KINDS] = {
        {0.85f, 0.60f, 0.28f}, {0.27f, 0.50f, 0.72f}, {0.45f, 0.66f, 0.35f},
        {0.76f, 0.33f, 0.30f}, {0.55f, 0.42f, 0.68f}, {0.35f, 0.68f, 0.68f},
        {0.83f, 0.50f, 0.65f}, {0.60f, 0.52f, 0.42f}, {0.62f, 0.64f, 0.66f},
        {0.80f, 0.76f, 0.32f},
    };
    const int i = kind % COLOURS_KINDS;
    return kinds[i < 0 ? i + COLOURS_KINDS : i];
}
