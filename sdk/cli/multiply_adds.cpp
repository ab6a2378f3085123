// What the processor can do at best: fused multiply-adds of floats that wait for nothing.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sdk/cli/multiply_adds.cpp"  // this file: compiled again for each instruction set
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "bench_table.h"

HWY_BEFORE_NAMESPACE();
namespace etendue::cli::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

double MultiplyAdds(std::size_t turns) {
  const hn::ScalableTag<float> d;
  using V = hn::Vec<decltype(d)>;
  // Twelve sums: two instructions a cycle with a latency of four or five, two pairs of three each where nothing is fused, and registers
  // left.
  const V factor = hn::Set(d, 0.999f), more = hn::Set(d, 0.001f);
  // Each begins elsewhere, where the compiler cannot know: none is left out because it equals another.
  const volatile float one = 1;
  const auto start = [&](float x) HWY_ATTR { return hn::Set(d, x * one); };
  V a0 = start(0), a1 = start(1), a2 = start(2), a3 = start(3), a4 = start(4), a5 = start(5), a6 = start(6), a7 = start(7), a8 = start(8),
    a9 = start(9), a10 = start(10), a11 = start(11);
  for (std::size_t i = 0; i < turns; ++i) {
    a0 = hn::MulAdd(a0, factor, more), a1 = hn::MulAdd(a1, factor, more), a2 = hn::MulAdd(a2, factor, more);
    a3 = hn::MulAdd(a3, factor, more), a4 = hn::MulAdd(a4, factor, more), a5 = hn::MulAdd(a5, factor, more);
    a6 = hn::MulAdd(a6, factor, more), a7 = hn::MulAdd(a7, factor, more), a8 = hn::MulAdd(a8, factor, more);
    a9 = hn::MulAdd(a9, factor, more), a10 = hn::MulAdd(a10, factor, more), a11 = hn::MulAdd(a11, factor, more);
  }
  const V sum = hn::Add(hn::Add(hn::Add(hn::Add(a0, a1), hn::Add(a2, a3)), hn::Add(hn::Add(a4, a5), hn::Add(a6, a7))),
                        hn::Add(hn::Add(a8, a9), hn::Add(a10, a11)));
  const volatile float kept = hn::GetLane(hn::SumOfLanes(d, sum));
  static_cast<void>(kept);
  return static_cast<double>(turns) * 24 * static_cast<double>(hn::Lanes(d));
}

}  // namespace etendue::cli::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace etendue::cli {

HWY_EXPORT(MultiplyAdds);

double multiply_adds(std::size_t turns) { return HWY_DYNAMIC_DISPATCH(MultiplyAdds)(turns); }

std::vector<InstructionSet> measured_instruction_sets() {
  // Of Highway's targets a lower bit is a better one.
  const std::int64_t supported = hwy::SupportedTargets() & HWY_TARGETS, best = supported & -supported;
  std::vector<InstructionSet> sets;
  for (const std::int64_t target : {best, std::int64_t{HWY_AVX2}, std::int64_t{HWY_SSE4}})
    if ((target & supported) != 0 && (sets.empty() || target > sets.back().target)) sets.push_back({hwy::TargetName(target), target, 0});
  return sets;
}

OnInstructionSet::OnInstructionSet(const InstructionSet& set) { hwy::DisableTargets(~set.target); }
OnInstructionSet::~OnInstructionSet() { hwy::DisableTargets(0); }

}  // namespace etendue::cli
#endif
