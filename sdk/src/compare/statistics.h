// Quantiles and corrections for sums of few, skewed samples. Derivations: sdk/docs/comparison.md.
#pragma once

namespace etendue::compare_detail {

// x with P(|N(0,1)| > x) = probability, 0 < probability < 1.
double two_sided_quantile(double probability);

// Each of `tests` independent tests gets this rate so that all together have `family_rate` (Sidak).
double sidak_rate(double family_rate, double tests);

// The standard normal deviate that is as improbable as Student's t with nu degrees of freedom
// (Wallace 1959, "Bounds on normal approximations to Student's and the chi-square distributions", eq. 4.2 with
// his constant): 1 % too small at most for nu >= 5, 2.5 % at 3.
double normal_from_t(double t, double nu);

// Hall's cubic transformation (1992, "On the removal of skewness by transformation", J. R. Statist. Soc. B 54, 221): for t = (mean - truth)
// / standard error with a mean of skewness `skewness`, a deviate without the skewness.
double without_skewness(double t, double skewness);

}  // namespace etendue::compare_detail
