// What one unit of the quantity that a light emits by amounts to in each other quantity: all conversions are a quotient of two of these.
// It is the axial intensity of punctual lights, the intensity across of lines, and the luminance of everything else.
#pragma once

#include "etendue/light_units.h"
#include "wide.h"

namespace etendue {

// Area of one side, and area seen along the axis (across a tube or a line's axis). Sizes are taken as they are.
Wide area_of(const SphereShape& sphere);
Wide area_of(const DiskShape& disk);
Wide area_of(const RectShape& rect);
Wide area_of(const PolygonShape& polygon);
Wide area_of(const TubeShape& tube);
Wide face_of(const SphereShape& sphere);
Wide face_of(const DiskShape& disk);
Wide face_of(const RectShape& rect);
Wide face_of(const PolygonShape& polygon);
Wide face_of(const TubeShape& tube);

// Steradians that, times the axial intensity, are the flux.
Wide solid_angle_of(const SpotShape& spot, const Conventions& conventions);
Wide solid_angle_of_frustum(const FrustumShape& frustum);

// Whether the sizes of a shape are ones that a light can have: SIZE_MISSING (0), NUMBER_INVALID.
Status check_size(const PointShape& point);
Status check_size(const SpotShape& spot);
Status check_size(const FrustumShape& frustum);
Status check_size(const BeamOfSolidAngle& beam);
Status check_size(const SphereShape& sphere);
Status check_size(const DiskShape& disk);
Status check_size(const RectShape& rect);
Status check_size(const PolygonShape& polygon);
Status check_size(const TubeShape& tube);
Status check_size(const SurfaceOfArea& surface);
Status check_size(const LineShape& line);
Status check_size(const DistantShape& distant);
Status check_size(const EnvironmentShape& environment);

// UNIT_UNSUITABLE where the shape does not know the quantity (with what to give instead in its hint), SIZE_MISSING, DISTANCE_MISSING,
// NUMBER_INVALID. Instantiated for every LightShape. `distance_m` is read for illuminances of near lights. Never 0, infinite or NaN: sizes
// so small or large that it would be are NUMBER_INVALID.
template <class S>
Result<Wide> ratio_of(const S& shape, Dimension quantity, const Conventions& conventions, std::optional<double> distance_m);

}  // namespace etendue
