"""Emitters that Mitsuba lacks, for the vectorised variants. Each takes a window: `falloff`, `exponent` and `range` as light.h has them
(range 0: none).

"etendue_lamp", a point that sends `intensity` (cd) into a cone (`cone_inner` and `cone_outer`, half angles in degrees; 180: none) or a
pyramid (`width` and `height`, full angles in degrees; 0: none) about its -Z, `to_world`.

"etendue_web", a photometric web without any baking: `filename` (a float picture, a row a plane and a column a polar angle, candelas in
its channels), `polar` and `azimuth` (the angles in degrees, separated by blanks), `type` (C, A or B), `half`, `quarter` (beyond which a
mirror folds the azimuth of type C, from its first plane), `mirror_polar`, `mirror_azimuth` (types A and B), `turn` (degrees),
`clockwise`, the cone as above, `to_world`. Linear in both angles, 0 outside the table.

"etendue_area", `area` with a window by the distance of each of its points: `radiance`, and `eye`, the place from which it is seen
without the window, to within `eye_radius`.
"""


def register_emitters(mi):
    import math

    import drjit as dr
    import numpy as np

    class Window:
        """What multiplies 1/d^2. Sources: light.h."""

        def __init__(self, props):
            self.law = props.get("falloff", "inverse_square")
            self.exponent, self.range = float(props.get("exponent", 0)), float(props.get("range", 0))

        def __call__(self, distance):
            x = dr.minimum(distance / self.range, 1) if self.range > 0 else mi.Float(0)

            def left(exponent):
                return 1 - x**exponent

            if self.law == "power":
                return left(self.exponent)
            if self.law == "power_squared":
                return dr.square(left(self.exponent))
            if self.law == "smoothstep":
                return dr.square(1 - x) * (1 + 2 * x)
            if self.law == "scale_bias":
                return left(2) / (1 - 1 / self.range**2)
            if self.law == "karis":
                return dr.square(left(4)) / (1 + 1 / dr.square(distance))
            return mi.Float(1)

    class Punctual(mi.Emitter):
        """A point that sends towards(direction) candelas towards a unit vector of its own frame."""

        def __init__(self, props):
            super().__init__(props)
            self.m_flags = mi.EmitterFlags.DeltaPosition
            matrix = np.array(props["to_world"].matrix, dtype=np.float64).reshape(4, 4)
            self.position = mi.Point3f(matrix[:3, 3].astype(np.float32))
            self.axes = [mi.Vector3f(matrix[:3, k].astype(np.float32)) for k in range(3)]
            self.inner, self.outer = (math.cos(math.radians(props.get(name, 180.0))) for name in ("cone_inner", "cone_outer"))
            self.window = Window(props)

        def passed(self, cosine):
            """The share that the cone lets through."""
            if self.outer == -1:
                return mi.Float(1)
            if self.outer == self.inner:
                return dr.select(cosine >= self.inner, mi.Float(1), 0)
            return dr.square(dr.clip((cosine - self.outer) / (self.inner - self.outer), 0, 1))

        def sample_direction(self, it, sample, active=True):
            to_light = self.position - it.p
            square = dr.squared_norm(to_light)
            ds = mi.DirectionSample3f()
            ds.p, ds.n, ds.uv, ds.time = self.position, mi.Normal3f(0), mi.Point2f(0.5), it.time
            ds.pdf, ds.delta, ds.emitter = mi.Float(1), mi.Bool(True), mi.EmitterPtr(self)
            ds.dist = dr.sqrt(square)
            ds.d = to_light / ds.dist
            local = mi.Vector3f(*(-dr.dot(axis, ds.d) for axis in self.axes))
            value = self.towards(local) * (self.passed(-local.z) * self.window(ds.dist) / square)
            return ds, dr.select(active, mi.Spectrum(value), 0)

        def pdf_direction(self, it, ds, active=True):
            return mi.Float(0)

        def eval_direction(self, it, ds, active=True):
            return mi.Spectrum(0)

        def eval(self, si, active=True):
            return mi.Spectrum(0)

        def bbox(self):
            return mi.ScalarBoundingBox3f(mi.ScalarPoint3f(*(float(c[0]) for c in self.position)))

        def to_string(self):
            return type(self).__name__

    class Lamp(Punctual):
        def __init__(self, props):
            super().__init__(props)
            self.intensity = props.get_emissive_texture("intensity")
            self.slopes = [math.tan(math.radians(float(props.get(name, 0)) / 2)) for name in ("width", "height")]

        def towards(self, direction):
            lit = mi.Bool(True)
            if self.slopes[0] > 0:
                ahead = -direction.z
                lit = (dr.abs(direction.x) <= ahead * self.slopes[0]) & (dr.abs(direction.y) <= ahead * self.slopes[1])
            return dr.select(lit, self.intensity.eval(dr.zeros(mi.SurfaceInteraction3f)), 0)

    def degrees(y, x):
        return dr.rad2deg(dr.atan2(y, x))

    class Axis:
        def __init__(self, text):
            nodes = [float(word) for word in text.split()]
            self.first, self.last, self.count = nodes[0], nodes[-1], len(nodes)
            self.nodes = mi.Float(nodes)

        def place(self, x):
            """The interval that holds x, and where x lies in it."""
            if self.count == 1:
                return mi.UInt32(0), mi.Float(0)
            above = dr.binary_search(0, self.count - 1, lambda i: dr.gather(mi.Float, self.nodes, i) <= x)
            interval = dr.clip(mi.Int32(above) - 1, 0, self.count - 2)
            lower, upper = dr.gather(mi.Float, self.nodes, interval), dr.gather(mi.Float, self.nodes, interval + 1)
            return mi.UInt32(interval), dr.clip((x - lower) / (upper - lower), 0, 1)

    class Web(Punctual):
        def __init__(self, props):
            super().__init__(props)
            self.type = props["type"]
            self.turn, self.half, self.quarter = (float(props[name]) for name in ("turn", "half", "quarter"))
            self.clockwise = bool(props["clockwise"])
            self.mirrors = bool(props["mirror_polar"]), bool(props["mirror_azimuth"])
            self.polar, self.azimuth = Axis(props["polar"]), Axis(props["azimuth"])
            table = mi.Bitmap(str(mi.file_resolver().resolve(props["filename"])))
            table = np.array(table.convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False))
            self.table = mi.Float(table.ravel())

        def towards(self, direction):
            """Candelas, the frame being the luminaire's."""
            x, y, z = direction.x, -direction.y if self.clockwise else direction.y, direction.z
            if self.type == "C":
                polar, azimuth = degrees(dr.sqrt(x * x + y * y), -z), degrees(y, x) - self.turn - self.azimuth.first
                azimuth -= 360 * dr.floor(azimuth / 360)
                azimuth = dr.select(azimuth > self.half, 360 - azimuth, azimuth)
                azimuth = dr.select(azimuth > self.quarter, 180 - azimuth, azimuth) + self.azimuth.first
            elif self.type == "A":
                polar, azimuth = 90 + degrees(x, dr.sqrt(y * y + z * z)), degrees(y, -z)
            else:
                polar, azimuth = 90 + degrees(y, dr.sqrt(x * x + z * z)), degrees(x, -z)
            if self.mirrors[0]:
                polar = dr.maximum(polar, 180 - polar)
            if self.mirrors[1]:
                azimuth = dr.abs(azimuth)
            lit = (polar >= self.polar.first) & (polar <= self.polar.last)
            if self.type != "C":
                lit &= (azimuth >= self.azimuth.first) & (azimuth <= self.azimuth.last)
            (i, s), (j, t) = self.polar.place(polar), self.azimuth.place(azimuth)

            def along(plane):
                first = plane * self.polar.count + i
                near, far = (dr.gather(mi.Color3f, self.table, first + k, lit) for k in (0, 1))
                return near + s * (far - near)

            near = along(j)
            return near if self.azimuth.count == 1 else near + t * (along(j + 1) - near)

    class Area(mi.Emitter):
        def __init__(self, props):
            super().__init__(props)
            self.radiance = props.get_emissive_texture("radiance")
            self.m_flags = mi.EmitterFlags.Surface
            if self.radiance.is_spatially_varying():
                self.m_flags |= mi.EmitterFlags.SpatiallyVarying
            self.eye, self.eye_radius = mi.Point3f(props["eye"]), float(props["eye_radius"])
            self.window = Window(props)

        def eval(self, si, active=True):
            origin = si.p + si.to_world(si.wi) * si.t
            seen = dr.squared_norm(origin - self.eye) < self.eye_radius**2
            weight = dr.select(seen, 1, self.window(si.t))
            return dr.select(active & (si.wi.z > 0), self.radiance.eval(si, active) * weight, 0)

        def sample_direction(self, it, sample, active=True):
            ds = self.get_shape().sample_direction(it, sample, active)
            active &= (dr.dot(ds.d, ds.n) < 0) & (ds.pdf > 0)
            si = mi.SurfaceInteraction3f(ds, it.wavelengths)
            ds.emitter = mi.EmitterPtr(self)
            return ds, dr.select(active, self.radiance.eval(si, active) * (self.window(ds.dist) / ds.pdf), 0)

        def pdf_direction(self, it, ds, active=True):
            active &= dr.dot(ds.d, ds.n) < 0
            return dr.select(active, self.get_shape().pdf_direction(it, ds, active), 0)

        def eval_direction(self, it, ds, active=True):
            si = mi.SurfaceInteraction3f(ds, it.wavelengths)
            return dr.select(active & (dr.dot(ds.d, ds.n) < 0), self.radiance.eval(si, active) * self.window(ds.dist), 0)

        def bbox(self):
            return self.get_shape().bbox()

        def to_string(self):
            return type(self).__name__

    mi.register_emitter("etendue_lamp", lambda props: Lamp(props))
    mi.register_emitter("etendue_web", lambda props: Web(props))
    mi.register_emitter("etendue_area", lambda props: Area(props))
