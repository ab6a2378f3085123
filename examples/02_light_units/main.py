"""The same 1500 lumens by what they come out of: candelas, nits, lux on a table 2 m away; and what has no answer."""

from etendue import Error, Point, Sphere, Spot, Tube, convert, explain, quantity

flux = 3 * quantity("500 lm")
lamps = {"point": Point(), "downlight": Spot("15 deg", "30 deg"), "globe": Sphere("15 cm"), "tube": Tube("1.2 m", "13 mm")}

print(f"{'':10} {'cd':>10} {'cd/m2':>12} {'lx':>10}")
for name, shape in lamps.items():
    candelas = convert(flux, "cd", shape=shape)
    lux = convert(flux, "lx", shape=shape, distance="2 m")
    try:
        nits = f"{convert(flux, 'nit', shape=shape):.2f}"
    except Error:  # UNIT_UNSUITABLE: it has no surface
        nits = "-"
    print(f"{name:10} {candelas:10.2f} {nits:>12} {lux:10.3f}")

for text, unit in [("1500 lm", "nit"), ("60 W", "lm")]:
    try:
        convert(text, unit)
    except Error as error:
        print(f"{text} in {unit}: {error.code}")
print(f"60 W at 15 lm/W: {convert('60 W at 15 lm/W', 'lm'):g} lm")
print(explain("1500 lm", "nit", shape=Sphere("15 cm")).formula)
