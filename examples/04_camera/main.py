"""A camera's settings as exposure values, and what somebody's calibration makes of a luminance at them."""

import math

from etendue import Error, camera, parse

for text in ["f/16 1/125 s ISO 100", "T2.8 180 deg @ 24 fps ISO 800 ND 0.9", "f/2.8 1/60 s ISO 400 +1.5 stop"]:
    settings = parse(text)
    assert isinstance(settings, camera.CameraSettings)
    print(f"{text:38} EV100 {camera.ev100(settings):6.3f}, as bright as {camera.effective_ev100(settings):6.3f}")

# A grey card of 18 % in the sun, 100 klx: .18 100000 / pi.
card, ev = 0.18 * 100000 / math.pi, 15.0
print(f"grey card {card:.0f} cd/m2, a meter says EV {camera.ev100_of_luminance(card):.2f}")
for name in ["frostbite", "unreal", "hdrp", "iso_sos"]:
    print(f"at EV {ev:.0f} by {name:10} pixel {card * camera.exposure_of_ev100(ev, name):.4f}")

try:
    camera.ev100_of_luminance(0.0)
except Error as error:
    print(f"EV of 0 cd/m2: {error.code}")
