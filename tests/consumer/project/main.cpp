// An 806 lm globe of 6 cm: what it is seen as, and what it gives on a surface that faces it 2 m away.
#include <etendue/eval.h>
#include <etendue/light.h>

#include <cstdio>

int main() {
  etendue::Light lamp;
  lamp.shape = etendue::SphereShape{0.03};
  lamp.emission.given = etendue::Emission::Given::flux;
  lamp.emission.value = 806;
  const etendue::Result<etendue::Resolved> globe = etendue::resolve(lamp);
  const etendue::Result<etendue::eval::Emitter> emitter = etendue::eval::emitter_of(lamp);
  if (!globe || !emitter) return 1;
  const etendue::Rgb lux = etendue::eval::illuminance(*emitter, {0, 0, 2}, {0, 0, -1});
  std::printf("%.1f cd/m2, %.2f lx\n", etendue::luminance_of(globe->rgb), etendue::luminance_of(lux));
  return 0;
}
