// What Mitsuba's `principled` has of a coat and of cloth, beside what glTF's extensions ask for: numbers, and parameters that make both as
// like as can be. Sources of the formulas: Burley 2012 (Disney's lobes, as Mitsuba 3 has them), Estevez and Kulla 2017 (sheen), the README
// files of KHR_materials_clearcoat and KHR_materials_sheen.
#pragma once

namespace etendue::mitsuba {

// Disney's coat has D = (a^2 - 1) / (pi ln a^2 (1 + (a^2 - 1) cos^2)), a in [.001, .1]. The a whose D is as high as that of GGX with this
// alpha, 1 / (pi alpha^2), or the end of the range that comes nearest.
double coat_width(double ggx_alpha);
// pi times its highest D.
double coat_peak(double width);

// Share of a white sky that a coat of F0 .04 and this width reflects there. Towards the mirror's direction `principled` has F cos^2 where
// the extension has F: its lobe is D G F / 4 times cos(light), without the division by both cosines.
double principled_coat_albedo(double width);

// Share of a white sky that sheen of colour 1 reflects: Disney's Schlick weight of the angle between light and half vector (`principled`),
// and the extension's cloth of a roughness.
double principled_sheen_albedo();
double cloth_albedo(double roughness);

}  // namespace etendue::mitsuba
