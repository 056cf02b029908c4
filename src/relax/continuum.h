#pragma once

#include <cmath>
#include <numbers>
#include <vector>

namespace fppg
{

/// What a half space filled with one unit of mass a unit of volume does to a particle outside it,
/// with the Wendland C2 kernel. Lengths are in dp.
///
/// Let P(D) be the integral of W over a plane at the distance D. By Gauss, the sum of -grad W over
/// the half space that begins there is P(D), away from it; and the integral of W over the half
/// space is M(D) = integral of P from D to the end of the support. With T = 1 - D / (2 h):
///   3D, W = 21 / (16 pi h^3) (1 - q/2)^4 (2 q + 1):
///     P = 21 / (2 h) T^5 (1 - 3/2 T + 4/7 T^2),  M = T^6 (7/2 - 9/2 T + 3/2 T^2)
///   2D, W = 7 / (4 pi h^2) (1 - q/2)^4 (2 q + 1), with x = D / h and
///   I_n = integral from x to 2 of q^n / sqrt(q^2 - x^2) dq:
///     P = 7 / (2 pi h) (I_1 - 5/2 I_3 + 5/2 I_4 - 15/16 I_5 + 1/8 I_6)
/// Both factors of W are those for which the integral of W is 1 (the paper's 21 / (6 pi h^3) is
/// not). In 2D a table is read, linear between 512 places: an error below 1e-5.
class HalfSpace
{
public:
    HalfSpace(double h, bool is_2d) : h_(h), reach_(2 * h)
    {
        if (is_2d) make_table();
    }

    double reach() const { return reach_; }

    /// P: the size of the force, for a distance not below 0.
    double force(double distance) const
    {
        if (distance >= reach_) return 0;
        if (!table_.empty()) return read(distance).force;
        const double t = 1 - distance / reach_;
        const double t2 = t * t;
        return 10.5 / h_ * t2 * t2 * t * (1 - 1.5 * t + 4.0 / 7.0 * t2);
    }

    /// M: the share of the kernel's support that is beyond, 0 to 1/2.
    double share(double distance) const
    {
        if (distance >= reach_) return 0;
        if (!table_.empty()) return read(distance).share;
        const double t = 1 - distance / reach_;
        const double t3 = t * t * t;
        return t3 * t3 * (3.5 - 4.5 * t + 1.5 * t * t);
    }

private:
    static constexpr int intervals = 512;
    struct Entry
    {
        double force = 0;
        double share = 0;
    };

    static double line_integral(double x)
    {
        const double x2 = x * x;
        const double s = std::sqrt(4 - x2);
        double integral[7];
        integral[0] = x > 0 ? std::log((2 + s) / x) : 0;
        integral[1] = s;
        double power = 2;
        for (int n = 2; n < 7; ++n, power *= 2)
            integral[n] = (power * s + (n - 1) * x2 * integral[n - 2]) / n;
        return integral[1] - 2.5 * integral[3] + 2.5 * integral[4] - 0.9375 * integral[5] +
               0.125 * integral[6];
    }

    void make_table()
    {
        table_.resize(intervals + 2);
        const auto at = [this](double place)
        { return 3.5 / std::numbers::pi / h_ * line_integral(2 * place / intervals); };
        const double step = reach_ / intervals;
        for (int n = intervals - 1; n >= 0; --n)
        {
            Entry& here = table_[static_cast<std::size_t>(n)];
            const Entry& next = table_[static_cast<std::size_t>(n) + 1];
            here.force = at(n);
            here.share = next.share + step / 6 * (here.force + 4 * at(n + 0.5) + next.force);
        }
    }

    Entry read(double distance) const
    {
        const double place = distance / reach_ * intervals;
        const auto n = static_cast<std::size_t>(place);
        const double part = place - static_cast<double>(n);
        const Entry &a = table_[n], &b = table_[n + 1];
        return {a.force + part * (b.force - a.force), a.share + part * (b.share - a.share)};
    }

    double h_;
    double reach_;
    std::vector<Entry> table_;
};

} // namespace fppg
