// What others compute colours of temperatures and temperatures of colours with, written from the published equations, many at once.
// Compiled for this very machine with -ffast-math and over separate arrays for each coordinate, which is the best a compiler gets to see.
#pragma once

#include <cstddef>

namespace etendue::bench {

// Krystek 1985, Color Res. Appl. 10, 38: quotients of quadratics in T for (u, v), 1000 K to 15000 K; Filament, Godot and colour-science use
// it.
void krystek_xy(const float* kelvin, float* x, float* y, std::size_t count);
void krystek_rgb(const float* kelvin, float* r, float* g, float* b, std::size_t count);
// Kang et al. 2002, J. Korean Phys. Soc. 41, 865 (and US 7024034, Kim): cubics in 1/T and x, 1667 K to 25000 K; MaterialX uses it.
void kang_xy(const float* kelvin, float* x, float* y, std::size_t count);
void kang_rgb(const float* kelvin, float* r, float* g, float* b, std::size_t count);
// Helland 2012: powers and logarithms fitted by eye to Charity's table; sRGB-encoded, 0 to 255, 1000 K to 40000 K.
void helland_srgb(const float* kelvin, float* r, float* g, float* b, std::size_t count);

// McCamy 1992, Color Res. Appl. 17, 142: a cubic of the direction to (.3320, .1858).
void mccamy(const float* x, const float* y, float* kelvin, std::size_t count);
// Hernandez-Andres, Lee and Romero 1999, Appl. Opt. 38, 5703: three exponentials of such a direction, here those for up to 50000 K.
void hernandez_andres(const float* x, const float* y, float* kelvin, std::size_t count);
// Robertson 1968, J. Opt. Soc. Am. 58, 1528: between the isotherms of a table of 31.
void robertson(const float* x, const float* y, float* kelvin, std::size_t count);

// The C library's exponential and logarithm in vectors, for K = 12.5.
void library_luminance(const float* ev, float* luminance, std::size_t count);
void library_ev(const float* luminance, float* ev, std::size_t count);
// The power function, as sRGB is usually written.
void library_srgb_to_linear(const float* encoded, float* linear, std::size_t count);
void library_linear_to_srgb(const float* linear, float* encoded, std::size_t count);

}  // namespace etendue::bench
