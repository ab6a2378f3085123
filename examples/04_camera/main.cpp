// A camera's settings as exposure values, and what somebody's calibration makes of a luminance at them.
#include "etendue/camera.h"
#include "etendue/quantity_text.h"

#include <cstdio>

int main() {
  using namespace etendue;
  for (const char* text : {"f/16 1/125 s ISO 100", "T2.8 180 deg @ 24 fps ISO 800 ND 0.9", "f/2.8 1/60 s ISO 400 +1.5 stop"}) {
    const auto camera = std::get<CameraSettings>(*parse(text));
    std::printf("%-38s EV100 %6.3f, as bright as %6.3f\n", text, *ev100(camera), *effective_ev100(camera));
  }

  // A grey card of 18 % in the sun, 100 klx: .18 100000 / pi.
  const double card = 0.18 * 100000 / pi, ev = 15;
  std::printf("grey card %.0f cd/m2, a meter says EV %.2f\n", card, *ev100_of_luminance(card, *calibration("frostbite")));
  for (const char* name : {"frostbite", "unreal", "hdrp", "iso_sos"})
    std::printf("at EV %.0f by %-10s pixel %.4f\n", ev, name, card * exposure_of_ev100(ev, *calibration(name)));

  const Result<double> ev_of_nothing = ev100_of_luminance(0, *calibration("frostbite"));
  std::printf("EV of 0 cd/m2: %s\n", ev_of_nothing.error().code.c_str());
}
