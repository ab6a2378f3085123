"""A photometric web inside Mitsuba without any baking: emitter "etendue_web", for the vectorised variants.

Parameters: `filename` (a float picture, a row a plane and a column a polar angle, candelas in its channels), `polar` and `azimuth` (the angles in
degrees, separated by blanks), `type` (C, A or B), `half`, `quarter` (beyond which a mirror folds the azimuth of type C, from its first plane),
`mirror_polar`, `mirror_azimuth` (types A and B), `turn` (degrees), `clockwise`, `cone_inner` and `cone_outer` (half angles of a spot's cone over it, in
degrees; 180: none), `to_world`. Linear in both angles, 0 outside the table.
"""


def register_web_emitter(mi):
    import math

    import drjit as dr
    import numpy as np

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

    class Web(mi.Emitter):
        def __init__(self, props):
            super().__init__(props)
            self.m_flags = mi.EmitterFlags.DeltaPosition
            matrix = np.array(props["to_world"].matrix, dtype=np.float64).reshape(4, 4)
            self.position = mi.Point3f(matrix[:3, 3].astype(np.float32))
            self.axes = [mi.Vector3f(matrix[:3, k].astype(np.float32)) for k in range(3)]
            self.type = props["type"]
            self.turn, self.half, self.quarter = (float(props[name]) for name in ("turn", "half", "quarter"))
            self.clockwise = bool(props["clockwise"])
            self.inner, self.outer = (math.cos(math.radians(props[name])) for name in ("cone_inner", "cone_outer"))
            self.mirrors = bool(props["mirror_polar"]), bool(props["mirror_azimuth"])
            self.polar, self.azimuth = Axis(props["polar"]), Axis(props["azimuth"])
            table = mi.Bitmap(str(mi.file_resolver().resolve(props["filename"])))
            table = np.array(table.convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False))
            self.table = mi.Float(table.ravel())

        def towards(self, direction):
            """cd towards a unit vector of the luminaire's frame."""
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
            return self.passed(-direction.z) * (near if self.azimuth.count == 1 else near + t * (along(j + 1) - near))

        def passed(self, cosine):
            """The share that the cone lets through."""
            if self.outer == self.inner:
                return dr.select(cosine >= self.inner, mi.Float(1), 0)
            ramp = dr.clip((cosine - self.outer) / (self.inner - self.outer), 0, 1)
            return ramp * ramp

        def sample_direction(self, it, sample, active=True):
            to_light = self.position - it.p
            square = dr.squared_norm(to_light)
            ds = mi.DirectionSample3f()
            ds.p, ds.n, ds.uv, ds.time = self.position, mi.Normal3f(0), mi.Point2f(0.5), it.time
            ds.pdf, ds.delta, ds.emitter = mi.Float(1), mi.Bool(True), mi.EmitterPtr(self)
            ds.dist = dr.sqrt(square)
            ds.d = to_light / ds.dist
            local = mi.Vector3f(*(-dr.dot(axis, ds.d) for axis in self.axes))
            return ds, dr.select(active, mi.Spectrum(self.towards(local)) / square, 0)

        def pdf_direction(self, it, ds, active=True):
            return mi.Float(0)

        def eval_direction(self, it, ds, active=True):
            return mi.Spectrum(0)

        def eval(self, si, active=True):
            return mi.Spectrum(0)

        def bbox(self):
            return mi.ScalarBoundingBox3f(mi.ScalarPoint3f(*(float(c[0]) for c in self.position)))

        def to_string(self):
            return "etendue_web"

    mi.register_emitter("etendue_web", lambda props: Web(props))
