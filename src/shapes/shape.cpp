#include "shapes/shape.h"

namespace fppg
{

bool has_surface(const Shape& shape)
{
    return !std::holds_alternative<PointsOp>(shape) && !std::holds_alternative<LinesOp>(shape) &&
           !std::holds_alternative<WaveOp>(shape);
}

bool has_polygons(const Shape& shape)
{
    return !std::holds_alternative<PointsOp>(shape) &&
           !std::holds_alternative<EllipsoidOp>(shape) && !std::holds_alternative<WaveOp>(shape);
}

} // namespace fppg
