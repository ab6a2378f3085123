#include "etendue/pixel.h"

#include "elementwise.h"
#include "module.h"

#include <cstdint>
#include <cstring>
#include <type_traits>

namespace etendue::python {
namespace {

template <class Pixel>
constexpr std::size_t channels = std::is_same_v<Pixel, float> ? 1 : 3;

// Codes as NumPy has them: whole numbers, or four bytes in a last extent.
template <class Code>
struct CodeArray {
  using Element = Code;
  static constexpr std::size_t per_code = 1;
};
template <>
struct CodeArray<Bytes4> {
  using Element = std::uint8_t;
  static constexpr std::size_t per_code = 4;
};

// An array that Python will own, of `count` elements of as many numbers as lie in its last extent.
template <class T>
struct Owned {
  T* values;
  nb::capsule owner;
  explicit Owned(std::size_t count) : values(new T[count + 1]), owner(values, [](void* p) noexcept { delete[] static_cast<T*>(p); }) {}
  NewArray<T> array(Extents extents, std::size_t last) const {
    if (last > 1) extents.push_back(last);
    return NewArray<T>(values, extents.size(), extents.data(), owner);
  }
};

constexpr const char* range_name(double*) { return "range"; }

using Counts = std::tuple<std::uint64_t, std::uint64_t, std::uint64_t>;
Counts numbers_of(const PackCounts& c) { return {c.nan, c.negative, c.overflow}; }

// Float pixels by the span, pack(pixels, codes, range...); double ones by the definition, exact(first channel, range..., counts): both
// round once.
template <class Pixel, class Code, class... Range, class Pack, class Exact>
void def_pack(nb::module_& m, const char* name, Pack pack, Exact exact) {
  using As = CodeArray<Code>;
  const auto code_extents = [](const auto& pixels) { return extents_of(pixels, pixels.ndim() - (channels<Pixel> > 1 ? 1 : 0)); };
  m.def(
      name,
      [pack, code_extents](const Array<float>& pixels, Range... range) {
        const std::size_t count = pixels.size() / channels<Pixel>;
        const Owned<typename As::Element> codes(count * As::per_code);
        const auto counts = [&] {
          const nb::gil_scoped_release others_may_run;
          return pack(std::span(reinterpret_cast<const Pixel*>(pixels.data()), count),
                      std::span(reinterpret_cast<Code*>(codes.values), count), range...);
        }();
        return std::make_tuple(codes.array(code_extents(pixels), As::per_code), numbers_of(unwrap(counts)));
      },
      nb::arg("pixels").noconvert(), nb::arg(range_name(static_cast<Range*>(nullptr)))...);
  m.def(
      name,
      [pack, exact, code_extents](const Array<double>& pixels, Range... range) {
        unwrap(pack(std::span<const Pixel>(), std::span<Code>(), range...));  // refuses an illegal range
        const std::size_t count = pixels.size() / channels<Pixel>;
        const Owned<typename As::Element> codes(count * As::per_code);
        PackCounts counts;
        {
          const nb::gil_scoped_release others_may_run;
          for (std::size_t i = 0; i < count; ++i) {
            const Code code = exact(pixels.data() + i * channels<Pixel>, range..., counts);
            std::memcpy(codes.values + i * As::per_code, &code, sizeof(Code));
          }
        }
        return std::make_tuple(codes.array(code_extents(pixels), As::per_code), numbers_of(counts));
      },
      nb::arg("pixels").noconvert(), nb::arg(range_name(static_cast<Range*>(nullptr)))...);
}

template <class Pixel, class Code, class... Range, class Unpack>
void def_unpack(nb::module_& m, const char* name, Unpack unpack) {
  using As = CodeArray<Code>;
  m.def(
      name,
      [unpack](const Array<typename As::Element>& codes, Range... range) {
        const std::size_t count = codes.size() / As::per_code;
        const Owned<float> pixels(count * channels<Pixel>);
        const auto status = [&] {
          const nb::gil_scoped_release others_may_run;
          return unpack(std::span(reinterpret_cast<const Code*>(codes.data()), count),
                        std::span(reinterpret_cast<Pixel*>(pixels.values), count), range...);
        }();
        unwrap(status);
        return pixels.array(extents_of(codes, codes.ndim() - (As::per_code > 1 ? 1 : 0)), channels<Pixel>);
      },
      nb::arg("codes").noconvert(), nb::arg(range_name(static_cast<Range*>(nullptr)))...);
}

Rgb rgb_at(const double* p) { return {p[0], p[1], p[2]}; }

}  // namespace

void bind_pixel(nb::module_& m) {
  using std::uint16_t;
  using std::uint32_t;
  def_pack<float, uint16_t>(
      m, "pack_half", [](auto pixels, auto codes) { return pack_half(pixels, codes); },
      [](const double* p, PackCounts& counts) { return pack_half(*p, counts); });
  def_unpack<float, uint16_t>(m, "unpack_half", [](auto codes, auto pixels) { return unpack_half(codes, pixels); });
  def_pack<Vec3f, uint32_t>(
      m, "pack_r11g11b10f", [](auto pixels, auto codes) { return pack_r11g11b10f(pixels, codes); },
      [](const double* p, PackCounts& counts) { return pack_r11g11b10f(rgb_at(p), counts); });
  def_unpack<Vec3f, uint32_t>(m, "unpack_r11g11b10f", [](auto codes, auto pixels) { return unpack_r11g11b10f(codes, pixels); });
  def_pack<Vec3f, uint32_t>(
      m, "pack_rgb9e5", [](auto pixels, auto codes) { return pack_rgb9e5(pixels, codes); },
      [](const double* p, PackCounts& counts) { return pack_rgb9e5(rgb_at(p), counts); });
  def_unpack<Vec3f, uint32_t>(m, "unpack_rgb9e5", [](auto codes, auto pixels) { return unpack_rgb9e5(codes, pixels); });
  def_pack<Vec3f, Bytes4>(
      m, "pack_rgbe", [](auto pixels, auto codes) { return pack_rgbe(pixels, codes); },
      [](const double* p, PackCounts& counts) { return pack_rgbe(rgb_at(p), counts); });
  def_unpack<Vec3f, Bytes4>(m, "unpack_rgbe", [](auto codes, auto pixels) { return unpack_rgbe(codes, pixels); });
  def_pack<Vec3f, uint32_t>(
      m, "pack_logluv", [](auto pixels, auto codes) { return pack_logluv(pixels, codes); },
      [](const double* p, PackCounts& counts) { return pack_logluv(rgb_at(p), counts); });
  def_unpack<Vec3f, uint32_t>(m, "unpack_logluv", [](auto codes, auto pixels) { return unpack_logluv(codes, pixels); });
  def_pack<Vec3f, uint32_t>(
      m, "pack_rgb10a2", [](auto pixels, auto codes) { return pack_rgb10a2(pixels, codes); },
      [](const double* p, PackCounts& counts) { return pack_rgb10a2(rgb_at(p), 1, counts); });
  def_unpack<Vec3f, uint32_t>(m, "unpack_rgb10a2", [](auto codes, auto pixels) { return unpack_rgb10a2(codes, pixels); });
  def_pack<Vec3f, Bytes4, double>(
      m, "pack_rgbm", [](auto pixels, auto codes, double range) { return pack_rgbm(pixels, codes, range); },
      [](const double* p, double range, PackCounts& counts) { return pack_rgbm(rgb_at(p), range, counts); });
  def_unpack<Vec3f, Bytes4, double>(m, "unpack_rgbm",
                                    [](auto codes, auto pixels, double range) { return unpack_rgbm(codes, pixels, range); });
  def_pack<Vec3f, Bytes4, double>(
      m, "pack_rgbd", [](auto pixels, auto codes, double range) { return pack_rgbd(pixels, codes, range); },
      [](const double* p, double range, PackCounts& counts) { return pack_rgbd(rgb_at(p), range, counts); });
  def_unpack<Vec3f, Bytes4, double>(m, "unpack_rgbd",
                                    [](auto codes, auto pixels, double range) { return unpack_rgbd(codes, pixels, range); });
}

}  // namespace etendue::python
