#include "peers.h"

#include <algorithm>
#include <cmath>

namespace etendue::bench {
namespace {

struct Xy {
  float x, y;
};
inline Xy krystek(float t) {
  const float u = (0.860117757f + 1.54118254e-4f * t + 1.28641212e-7f * t * t) / (1 + 8.42420235e-4f * t + 7.08145163e-7f * t * t);
  const float v = (0.317398726f + 4.22806245e-5f * t + 4.20481691e-8f * t * t) / (1 - 2.89741816e-5f * t + 1.61456053e-7f * t * t);
  const float scale = 1 / (2 * u - 8 * v + 4);
  return {3 * u * scale, 2 * v * scale};
}
inline Xy kang(float t) {
  const float m = 1e3f / t;
  const float x = t <= 4000 ? ((-0.2661239f * m - 0.2343589f) * m + 0.8776956f) * m + 0.179910f
                            : ((-3.0258469f * m + 2.1070379f) * m + 0.2226347f) * m + 0.240390f;
  const float low = ((-1.1063814f * x - 1.34811020f) * x + 2.18555832f) * x - 0.20219683f;
  const float middle = ((-0.9549476f * x - 1.37418593f) * x + 2.09137015f) * x - 0.16748867f;
  const float high = ((3.0817580f * x - 5.87338670f) * x + 3.75112997f) * x - 0.37001483f;
  return {x, t <= 2222 ? low : t <= 4000 ? middle : high};
}
// Linear Rec.709 with Y = 1, the matrix of IEC 61966-2-1 to its printed digits.
inline void rgb_of(Xy c, float& r, float& g, float& b) {
  const float x = c.x / c.y, z = (1 - c.x - c.y) / c.y;
  r = 3.2406f * x - 1.5372f - 0.4986f * z;
  g = -0.9689f * x + 1.8758f + 0.0415f * z;
  b = 0.0557f * x - 0.2040f + 1.0570f * z;
}
inline float byte(float v) { return std::min(std::max(v, 0.0f), 255.0f); }

// Wyszecki and Stiles 1982, table 1(3.11): mired, u, v and slope of the isotherm in CIE 1960, with 325 mired's u as corrected since
// (.24792).
struct Isotherm {
  float mired, u, v, slope;
};
constexpr Isotherm isotherms[] = {{0, .18006f, .26352f, -.24341f},   {10, .18066f, .26589f, -.25479f},  {20, .18133f, .26846f, -.26876f},
                                  {30, .18208f, .27119f, -.28539f},  {40, .18293f, .27407f, -.30470f},  {50, .18388f, .27709f, -.32675f},
                                  {60, .18494f, .28021f, -.35156f},  {70, .18611f, .28342f, -.37915f},  {80, .18740f, .28668f, -.40955f},
                                  {90, .18880f, .28997f, -.44278f},  {100, .19032f, .29326f, -.47888f}, {125, .19462f, .30141f, -.58204f},
                                  {150, .19962f, .30921f, -.70471f}, {175, .20525f, .31647f, -.84901f}, {200, .21142f, .32312f, -1.0182f},
                                  {225, .21807f, .32909f, -1.2168f}, {250, .22511f, .33439f, -1.4512f}, {275, .23247f, .33904f, -1.7298f},
                                  {300, .24010f, .34308f, -2.0637f}, {325, .24792f, .34655f, -2.4681f}, {350, .25591f, .34951f, -2.9641f},
                                  {375, .26400f, .35200f, -3.5814f}, {400, .27218f, .35407f, -4.3633f}, {425, .28039f, .35577f, -5.3762f},
                                  {450, .28863f, .35714f, -6.7262f}, {475, .29685f, .35823f, -8.5955f}, {500, .30505f, .35907f, -11.324f},
                                  {525, .31320f, .35968f, -15.628f}, {550, .32129f, .36011f, -23.325f}, {575, .32931f, .36038f, -40.770f},
                                  {600, .33724f, .36051f, -116.45f}};
inline float distance_to(const Isotherm& line, float u, float v) {
  return ((v - line.v) - line.slope * (u - line.u)) / std::sqrt(1 + line.slope * line.slope);
}

}  // namespace

void krystek_xy(const float* kelvin, float* __restrict x, float* __restrict y, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    const Xy c = krystek(kelvin[i]);
    x[i] = c.x;
    y[i] = c.y;
  }
}
void krystek_rgb(const float* kelvin, float* __restrict r, float* __restrict g, float* __restrict b, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) rgb_of(krystek(kelvin[i]), r[i], g[i], b[i]);
}
void kang_xy(const float* kelvin, float* __restrict x, float* __restrict y, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    const Xy c = kang(kelvin[i]);
    x[i] = c.x;
    y[i] = c.y;
  }
}
void kang_rgb(const float* kelvin, float* __restrict r, float* __restrict g, float* __restrict b, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) rgb_of(kang(kelvin[i]), r[i], g[i], b[i]);
}
void helland_srgb(const float* kelvin, float* __restrict r, float* __restrict g, float* __restrict b, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    const float t = kelvin[i] / 100, above = std::max(t - 60, 1.0f);
    r[i] = byte(t <= 66 ? 255.0f : 329.698727446f * std::pow(above, -0.1332047592f));
    g[i] = byte(t <= 66 ? 99.4708025861f * std::log(t) - 161.1195681661f : 288.1221695283f * std::pow(above, -0.0755148492f));
    b[i] = byte(t >= 66 ? 255.0f : t <= 19 ? 0.0f : 138.5177312231f * std::log(std::max(t - 10, 1.0f)) - 305.0447927307f);
  }
}

void mccamy(const float* x, const float* y, float* __restrict kelvin, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    const float n = (x[i] - 0.3320f) / (0.1858f - y[i]);
    kelvin[i] = ((449 * n + 3525) * n + 6823.3f) * n + 5520.33f;
  }
}
void hernandez_andres(const float* x, const float* y, float* __restrict kelvin, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    const float n = (x[i] - 0.3366f) / (y[i] - 0.1735f);
    kelvin[i] =
        -949.86315f + 6253.80338f * std::exp(-n / 0.92159f) + 28.70599f * std::exp(-n / 0.20039f) + 0.00004f * std::exp(-n / 0.07125f);
  }
}
void robertson(const float* x, const float* y, float* __restrict kelvin, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    const float scale = 1 / (-2 * x[i] + 12 * y[i] + 3), u = 4 * x[i] * scale, v = 6 * y[i] * scale;
    float before = distance_to(isotherms[0], u, v);
    float mired = isotherms[30].mired;
    for (int k = 1; k < 31; ++k) {
      const float here = distance_to(isotherms[k], u, v);
      if (here < 0) {
        mired = isotherms[k - 1].mired + (isotherms[k].mired - isotherms[k - 1].mired) * before / (before - here);
        break;
      }
      before = here;
    }
    kelvin[i] = 1e6f / mired;
  }
}

void library_luminance(const float* ev, float* __restrict luminance, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) luminance[i] = std::exp2(ev[i]) * 0.125f;
}
void library_ev(const float* luminance, float* __restrict ev, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) ev[i] = std::log2(luminance[i]) + 3;
}
void library_srgb_to_linear(const float* encoded, float* __restrict linear, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i)
    linear[i] = encoded[i] <= 0.04045f ? encoded[i] * (1 / 12.92f) : std::pow((encoded[i] + 0.055f) * (1 / 1.055f), 2.4f);
}
void library_linear_to_srgb(const float* linear, float* __restrict encoded, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i)
    encoded[i] = linear[i] <= 0.0031308f ? linear[i] * 12.92f : 1.055f * std::pow(linear[i], 1 / 2.4f) - 0.055f;
}

}  // namespace etendue::bench
