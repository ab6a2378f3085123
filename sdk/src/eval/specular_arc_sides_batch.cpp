// specular_outline.h: lights whose arcs stand in a table (specular_arc_table.h).
#include "specular_arc_table.h"

#include "light_batch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "eval/specular_arc_sides_batch.cpp"  // this file: compiled again for each instruction set
#include <hwy/foreach_target.h>

#include "eval/specular_sides-inl.h"

HWY_BEFORE_NAMESPACE();
namespace etendue::eval::HWY_NAMESPACE {
namespace {

void LayArcSides(const OutlinedLight& light, const ArcTable& table, const PlaceBlock& places, std::size_t count, SideBlock& block) {
  const Doubles d;
  const Wide zero = wide(0);
  block.make_room(table.arcs, ArcTable::along_horizon, table.rims);
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const WidePoints points(places, i);
    SideLayer layer(points, block, i);
    for (std::size_t side = 0; side < block.sides; ++side) {
      const std::size_t index = side < table.arcs ? side : ArcTable::most_arcs + side - table.arcs;
      const auto load = [&](std::size_t k) ETENDUE_INLINE_LAMBDA { return hn::LoadU(d, table.arc[k].data() + index * points_at_once + i); };
      const auto vector = [&](std::size_t k) ETENDUE_INLINE_LAMBDA { return Wide3{load(k), load(k + 1), load(k + 2)}; };
      const Wide reach = load(ArcTable::reach);
      const WideArc arc{vector(ArcTable::centre_x), vector(ArcTable::u_x), vector(ArcTable::v_x), reach, hn::Gt(reach, wide(1e-9))};
      if (table.rims) {
        layer.lay_rim(side, arc);
      } else {
        layer.lay(side, arc);
      }
    }
    if (table.rims) layer.illuminance = hn::LoadU(d, table.illuminance.data() + i);
    const auto marked = [&](const std::array<bool, points_at_once>& marks) {
      HWY_ALIGN std::array<double, hn::MaxLanes(Doubles())> numbers;
      for (std::size_t k = 0; k < hn::Lanes(d); ++k) numbers[k] = marks[i + k] ? 1 : 0;
      return hn::Gt(hn::Load(d, numbers.data()), zero);
    };
    layer.doubtful = marked(table.doubtful);
    layer.finish(light, hn::Gt(layer.illuminance, zero), marked(table.inside));
  }
}

}  // namespace
}  // namespace etendue::eval::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace etendue::eval {

HWY_EXPORT(LayArcSides);

void lay_arc_sides(const OutlinedLight& light, const PlaceBlock& places, std::size_t count, SideBlock& block) {
  thread_local ArcTable table;
  fill_arcs(light, places, count, table);
  HWY_DYNAMIC_DISPATCH(LayArcSides)(light, table, places, count, block);
}

}  // namespace etendue::eval
#endif
