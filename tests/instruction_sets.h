// Runs a test on every instruction set that the machine has, for which the kernels are compiled.
#pragma once

#include <gtest/gtest.h>
#include <hwy/highway.h>

namespace etendue {

template <class Test>
void on_each_instruction_set(Test test) {
  for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    hwy::SetSupportedTargetsForTest(target);
    test();
  }
  hwy::SetSupportedTargetsForTest(0);
}

}  // namespace etendue
