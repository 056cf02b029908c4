#include "fppg/vec.h"

namespace fppg
{

Transform operator*(const Transform& a, const Transform& b)
{
    Transform out;
    for (int row = 0; row < 3; ++row)
    {
        const Vec3& r = a.linear[static_cast<std::size_t>(row)];
        Vec3& o = out.linear[static_cast<std::size_t>(row)];
        for (int col = 0; col < 3; ++col)
            o[col] = r.x * b.linear[0][col] + r.y * b.linear[1][col] + r.z * b.linear[2][col];
    }
    out.offset = a(b.offset);
    return out;
}

} // namespace fppg
