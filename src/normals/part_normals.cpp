#include "normals/part_normals.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <tuple>

namespace fppg
{

PartSurface::PartSurface(const std::vector<Vec3>& selected, const Vec3& low, const Vec3& high,
                         double dp, double reach)
    : low_(low), dp_(dp), columns_(column(high.x) + 1), rows_(row(high.z) + 1)
{
    is_taken_.resize(static_cast<std::size_t>(columns_ * rows_), false);
    for (const Vec3& p : selected)
        is_taken_[static_cast<std::size_t>(row(p.z) * columns_ + column(p.x))] = true;
    // A node that counts is no farther than the box is wide.
    const double most = static_cast<double>(std::max(columns_, rows_));
    const auto last = static_cast<int>(std::min(reach / dp + 1, most));
    // Room for rounding: sizes are compared with the reach as GenCase v5.4.354 does, limit
    // included.
    const double limit = 4 * (reach / dp) * (reach / dp) * (1 + 1e-9);
    const auto from_middle = [](int a)
    { return a == 0 ? std::int64_t{0} : std::int64_t{2} * std::abs(a) - 1; };
    for (int z = -last; z <= last; ++z)
        for (int x = -last; x <= last; ++x)
        {
            const std::int64_t surface =
                from_middle(x) * from_middle(x) + from_middle(z) * from_middle(z);
            if (surface == 0 || static_cast<double>(surface) > limit) continue;
            steps_.push_back({x, z, surface, std::int64_t{x} * x + std::int64_t{z} * z});
        }
    std::sort(steps_.begin(), steps_.end(),
              [](const Step& a, const Step& b)
              {
                  return std::tuple(a.surface, -a.length, a.z, a.x) <
                         std::tuple(b.surface, -b.length, b.z, b.x);
              });
}

std::int64_t PartSurface::column(double x) const
{
    return std::llround((x - low_.x) / dp_);
}

std::int64_t PartSurface::row(double z) const
{
    return std::llround((z - low_.z) / dp_);
}

bool PartSurface::is_empty(std::int64_t x, std::int64_t z) const
{
    return x >= 0 && x < columns_ && z >= 0 && z < rows_ &&
           !is_taken_[static_cast<std::size_t>(z * columns_ + x)];
}

Vec3 PartSurface::normal_at(const Vec3& particle) const
{
    const std::int64_t x = column(particle.x);
    const std::int64_t z = row(particle.z);
    const auto first = std::find_if(steps_.begin(), steps_.end(),
                                    [&](const Step& s) { return is_empty(x + s.x, z + s.z); });
    if (first == steps_.end()) return {};
    std::vector<std::pair<int, int>> taken;
    int sum_x = 0;
    int sum_z = 0;
    for (auto s = first;
         s != steps_.end() && s->surface == first->surface && s->length == first->length; ++s)
    {
        if (!is_empty(x + s->x, z + s->z)) continue;
        if (std::find(taken.begin(), taken.end(), std::pair(-s->x, -s->z)) != taken.end()) continue;
        taken.emplace_back(s->x, s->z);
        sum_x += s->x;
        sum_z += s->z;
    }
    const double scale =
        0.5 * dp_ *
        std::sqrt(static_cast<double>(first->surface) / static_cast<double>(first->length));
    return {scale * sum_x, 0, scale * sum_z};
}

} // namespace fppg
