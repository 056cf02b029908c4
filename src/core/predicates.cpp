#include "core/predicates.h"

#include <array>
#include <cstddef>

namespace fppg
{

namespace
{

/// A sum of doubles without any rounding: components that do not overlap, smallest first.
template <std::size_t capacity>
class ExactSum
{
public:
    void add(double value)
    {
        std::size_t kept = 0;
        double carry = value;
        for (std::size_t i = 0; i < size_; ++i)
        {
            const double old = parts_[i];
            const double sum = old + carry;
            const double virtual_part = sum - old;
            const double error = (old - (sum - virtual_part)) + (carry - virtual_part);
            if (error != 0) parts_[kept++] = error;
            carry = sum;
        }
        if (carry != 0) parts_[kept++] = carry;
        size_ = kept;
    }
    void add_product(double a, double b)
    {
        const double product = a * b;
        add(std::fma(a, b, -product));
        add(product);
    }
    void add_product(double a, double b, double c)
    {
        const double product = a * b;
        add_product(std::fma(a, b, -product), c);
        add_product(product, c);
    }
    int sign() const { return size_ == 0 ? 0 : sign_of(parts_[size_ - 1]); }

private:
    std::array<double, capacity> parts_{};
    std::size_t size_ = 0;
};

} // namespace

int orient2d_exact(double ax, double ay, double bx, double by, double px, double py)
{
    ExactSum<12> sum;
    sum.add_product(ax, by);
    sum.add_product(-ay, bx);
    sum.add_product(bx, py);
    sum.add_product(-by, px);
    sum.add_product(px, ay);
    sum.add_product(-py, ax);
    return sum.sign();
}

int orient3d_exact(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
    ExactSum<96> sum;
    const auto add_determinant = [&sum](double sign, const Vec3& p, const Vec3& q, const Vec3& r)
    {
        sum.add_product(sign * p.x, q.y, r.z);
        sum.add_product(-sign * p.x, q.z, r.y);
        sum.add_product(sign * p.y, q.z, r.x);
        sum.add_product(-sign * p.y, q.x, r.z);
        sum.add_product(sign * p.z, q.x, r.y);
        sum.add_product(-sign * p.z, q.y, r.x);
    };
    add_determinant(1, a, b, c);
    add_determinant(-1, a, b, d);
    add_determinant(1, a, c, d);
    add_determinant(-1, b, c, d);
    return sum.sign();
}

int orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d)
{
    constexpr double bound = 7.771561172376103e-16; // (7 + 56 u) u, u = 2^-53
    const Vec3 ad = a - d;
    const Vec3 bd = b - d;
    const Vec3 cd = c - d;
    const double bc = bd.x * cd.y;
    const double cb = cd.x * bd.y;
    const double ca = cd.x * ad.y;
    const double ac = ad.x * cd.y;
    const double ab = ad.x * bd.y;
    const double ba = bd.x * ad.y;
    const double det = ad.z * (bc - cb) + bd.z * (ca - ac) + cd.z * (ab - ba);
    const double permanent = (std::abs(bc) + std::abs(cb)) * std::abs(ad.z) +
                             (std::abs(ca) + std::abs(ac)) * std::abs(bd.z) +
                             (std::abs(ab) + std::abs(ba)) * std::abs(cd.z);
    if (std::abs(det) > bound * permanent) return sign_of(det);
    return orient3d_exact(a, b, c, d);
}

} // namespace fppg
