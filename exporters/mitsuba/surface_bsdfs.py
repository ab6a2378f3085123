"""Surface models that Mitsuba lacks, as BSDFs for the vectorised variants: a diffuse lobe and round GGX facets with Schlick's Fresnel.

"etendue_standard", Frostbite's (Lagarde and de Rousiers 2014, 3.1, 3.2): `base_colour`, `metal`, `roughness`, `reflectance` (a number).
"etendue_metal_rough", glTF 2.0's (appendix B): `base_colour`, `metallic`, `roughness`, `ior` (a number).
"etendue_specular_glossiness", glTF's archived extension: `diffuse`, `specular`, `glossiness`.

All but the numbers may be textures. Front side alone: `twosided` gives the other one. Directions are chosen among the facets that the
view sees (Heitz 2018) or by the cosine.
"""


def register_surface_bsdfs(mi):
    import drjit as dr

    least_alpha = 1e-4

    def schlick_weight(cosine):
        x = dr.clip(1 - cosine, 0, 1)
        return dr.square(dr.square(x)) * x

    def mean(colour):
        return (colour.x + colour.y + colour.z) / 3

    class Ggx:
        """Facets as one view sees them. The sine of the half vector comes from its components: D keeps its digits at an alpha of 1e-4."""

        def __init__(self, roughness, correlated, view):
            self.alpha = dr.maximum(dr.square(roughness), least_alpha)
            self.square = dr.square(self.alpha)
            self.correlated, self.view = correlated, view
            self.view_root = self.root(view.z)

        def root(self, cosine):
            return dr.sqrt(dr.fma(cosine, cosine, self.square * (1 - dr.square(cosine))))

        def density(self, light):
            sum = self.view + light
            across, along = dr.square(sum.x) + dr.square(sum.y), dr.square(sum.z)
            d = (self.square * along + across) / (along + across)
            return self.square / (dr.pi * dr.square(d))

        def masked(self, cosine):
            """G / (4 n.v n.l)."""
            if self.correlated:
                return 0.5 / (cosine * self.view_root + self.view.z * self.root(cosine))
            return 1 / ((self.view.z + self.view_root) * (cosine + self.root(cosine)))

        def pdf(self, density):
            return density / (2 * (self.view.z + self.view_root))

        def sample(self, u):
            stretched = dr.normalize(mi.Vector3f(self.alpha * self.view.x, self.alpha * self.view.y, self.view.z))
            across = dr.square(stretched.x) + dr.square(stretched.y)
            t1 = mi.Vector3f(-stretched.y, stretched.x, 0) * dr.rsqrt(dr.maximum(across, 1e-30))
            t1 = dr.select(across > 0, t1, mi.Vector3f(1, 0, 0))
            t2 = dr.cross(stretched, t1)
            r, (sin, cos) = dr.sqrt(u.x), dr.sincos(2 * dr.pi * u.y)
            p1, s = r * cos, 0.5 * (1 + stretched.z)
            left = dr.safe_sqrt(1 - dr.square(p1))
            p2 = (1 - s) * left + s * r * sin
            h = t1 * p1 + t2 * p2 + stretched * dr.safe_sqrt(dr.square(left) - dr.square(p2))
            h = dr.normalize(mi.Vector3f(self.alpha * h.x, self.alpha * h.y, dr.maximum(h.z, 1e-7)))
            return h * (2 * dr.dot(self.view, h)) - self.view

    class Surface(mi.BSDF):
        def __init__(self, props):
            super().__init__(props)
            kinds, front = mi.BSDFFlags, mi.BSDFFlags.FrontSide
            glossy, diffuse = kinds.GlossyReflection | front, kinds.DiffuseReflection | front
            self.m_components, self.m_flags = [glossy, diffuse], glossy | diffuse

        def mixture(self, si, active):
            """The lobes at a place, the facets, and the share of directions chosen among them: what they reflect to the view of all, but
            more of narrow ones, which directions chosen on a light do not find: they find the diffuse light."""
            lobes = self.lobes(si, active)
            facets = Ggx(lobes.roughness, self.correlated, si.wi)
            weight = schlick_weight(si.wi.z)
            specular, diffuse = mean(lobes.f0 * (1 - weight) + lobes.f90 * weight), mean(lobes.albedo)
            share = dr.clip(specular / (specular + diffuse), dr.maximum(0.1, 0.75 * (1 - facets.alpha)), 0.9)
            share = dr.select(diffuse > 0, dr.select(specular > 0, share, 0), 1)
            return lobes, facets, share

        def value_and_pdf(self, si, light, mixture, active):
            lobes, facets, share = mixture
            active &= (si.wi.z > 0) & (light.z > 0)
            cosine_vh = 0.5 * dr.norm(si.wi + light)
            weight, density = schlick_weight(cosine_vh), facets.density(light)
            fresnel = lobes.f0 * (1 - weight) + lobes.f90 * weight
            diffuse = self.diffuse(lobes, si.wi.z, light.z, cosine_vh, weight)
            value = diffuse * (light.z / dr.pi) + fresnel * (density * facets.masked(light.z) * light.z)
            pdf = share * facets.pdf(density) + (1 - share) * light.z / dr.pi
            return dr.select(active, mi.Spectrum(value), 0), dr.select(active, pdf, 0)

        def eval_pdf(self, ctx, si, wo, active=True):
            return self.value_and_pdf(si, wo, self.mixture(si, active), active)

        def eval(self, ctx, si, wo, active=True):
            return self.eval_pdf(ctx, si, wo, active)[0]

        def pdf(self, ctx, si, wo, active=True):
            return self.eval_pdf(ctx, si, wo, active)[1]

        def sample(self, ctx, si, sample1, sample2, active=True):
            mixture = self.mixture(si, active)
            _, facets, share = mixture
            glossy = sample1 < share
            bs = mi.BSDFSample3f()
            bs.wo = dr.normalize(dr.select(glossy, facets.sample(sample2), mi.warp.square_to_cosine_hemisphere(sample2)))
            value, bs.pdf = self.value_and_pdf(si, bs.wo, mixture, active)
            bs.eta = 1
            bs.sampled_component = dr.select(glossy, mi.UInt32(0), mi.UInt32(1))
            kinds = (mi.UInt32(+kind) for kind in (mi.BSDFFlags.GlossyReflection, mi.BSDFFlags.DiffuseReflection))
            bs.sampled_type = dr.select(glossy, *kinds)
            return bs, dr.select(bs.pdf > 0, value / bs.pdf, 0)

        def to_string(self):
            return type(self).__name__

    class Lobes:
        def __init__(self, albedo, f0, f90, roughness):
            self.albedo, self.f0, self.f90, self.roughness = albedo, f0, f90, roughness

    class Standard(Surface):
        """f90 = min(50 dot(f0, .33), 1). Disney's diffuse with F90 = .5 r + 2 r (v.h)^2, times lerp(1, 1 / 1.51, r)."""

        correlated = True

        def __init__(self, props):
            super().__init__(props)
            self.base_colour, self.metal, self.roughness = (props.get_texture(name) for name in ("base_colour", "metal", "roughness"))
            self.f0 = 0.16 * props["reflectance"] ** 2

        def lobes(self, si, active):
            base = self.base_colour.eval(si, active)
            metal, roughness = self.metal.eval_1(si, active), self.roughness.eval_1(si, active)
            f0 = self.f0 * (1 - metal) + base * metal
            f90 = dr.minimum(50 * 0.33 * (f0.x + f0.y + f0.z), 1)
            return Lobes(base * ((1 - metal) * (1 + roughness * (1 / 1.51 - 1))), f0, f90, roughness)

        def diffuse(self, lobes, cosine_view, cosine_light, cosine_vh, weight):
            above_1 = lobes.roughness * (0.5 + 2 * dr.square(cosine_vh)) - 1
            return lobes.albedo * ((1 + above_1 * schlick_weight(cosine_view)) * (1 + above_1 * schlick_weight(cosine_light)))

    class MetalRough(Surface):
        """A metal of the base colour mixed with a dielectric, which has what its Fresnel reflection leaves diffused."""

        correlated = False

        def __init__(self, props):
            super().__init__(props)
            self.base_colour, self.metallic = props.get_texture("base_colour"), props.get_texture("metallic")
            self.roughness = props.get_texture("roughness")
            self.f0 = ((props["ior"] - 1) / (props["ior"] + 1)) ** 2

        def lobes(self, si, active):
            base, metallic = self.base_colour.eval(si, active), self.metallic.eval_1(si, active)
            f0 = self.f0 * (1 - metallic) + base * metallic
            return Lobes(base * (1 - metallic), f0, mi.Float(1), self.roughness.eval_1(si, active))

        def diffuse(self, lobes, cosine_view, cosine_light, cosine_vh, weight):
            return lobes.albedo * ((1 - self.f0) * (1 - weight))

    class SpecularGlossiness(Surface):
        """Diffuse colour times what the strongest channel of F0 leaves, times what the Fresnel reflection leaves."""

        correlated = False

        def __init__(self, props):
            super().__init__(props)
            self.colour, self.specular, self.glossiness = (props.get_texture(name) for name in ("diffuse", "specular", "glossiness"))

        def lobes(self, si, active):
            f0 = self.specular.eval(si, active)
            left = 1 - dr.maximum(f0.x, dr.maximum(f0.y, f0.z))
            return Lobes(self.colour.eval(si, active) * left, f0, mi.Float(1), 1 - self.glossiness.eval_1(si, active))

        def diffuse(self, lobes, cosine_view, cosine_light, cosine_vh, weight):
            return lobes.albedo * ((1 - lobes.f0) * (1 - weight))

    mi.register_bsdf("etendue_standard", lambda props: Standard(props))
    mi.register_bsdf("etendue_metal_rough", lambda props: MetalRough(props))
    mi.register_bsdf("etendue_specular_glossiness", lambda props: SpecularGlossiness(props))
