#pragma once

#include "fppg/vec.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace fppg
{

/// Where lanes without a point are, dp: its square is still a float.
inline constexpr float far_away_dp = 1e18f;

/// Points near a place, by eights: offsets from the place in dp. Lanes behind the last are far
/// away.
struct NearPoints
{
    std::vector<float> x, y, z;
    std::vector<std::uint32_t> index;
    std::size_t count = 0;

    /// Room for `n` points and 24 more, all far away.
    void reserve(std::size_t n);
    void push_back(const Vec3& offset, std::uint32_t point);
    Vec3 offset(std::size_t at) const { return {x[at], y[at], z[at]}; }
};

/// What is nearest to a place amid points near another one.
struct NearestPoint
{
    float squared = 0;    ///< distance squared, dp; far beyond all reach if there is none
    std::uint32_t at = 0; ///< in the list
};

using EightNumbers = std::array<float, 8>;

/// The same for eight places.
struct NearestPoints
{
    EightNumbers squared;
    std::array<std::uint32_t, 8> at;
};

/// The points of one chart and what comes near it, sorted into cells for "who is nearer than r".
/// Points come one by one, none leaves. Distances are compared as floats, in dp.
class ChartGrid
{
public:
    /// Largest radius that is asked for, dp.
    static constexpr double reach = 2;

    ChartGrid() : heads_(slot_count, none) {}

    /// dp      metres
    /// origin  a point amid the points to come
    void start(double dp, const Vec3& origin);

    std::uint32_t size() const { return static_cast<std::uint32_t>(points_.size()); }
    const Vec3& point(std::uint32_t index) const { return points_[index]; }

    /// Points are numbered from 0 as they come.
    void add(const Vec3& point);

    /// Lists the points nearer than `radius` (dp, at most the reach) to a place, in an order that
    /// depends only on the points and the order of their coming.
    void find_near(const Vec3& place, double radius, NearPoints& near) const;

    /// Calls body(index, offset from the place in metres, distance squared) for every point nearer
    /// than `radius` dp; offsets are exact.
    template <typename Body>
    void for_each_near(const Vec3& place, double radius, NearPoints& spare, const Body& body) const
    {
        // Floats choose with some room.
        find_near(place, 1.0005 * radius, spare);
        const double limit = radius * radius * dp_ * dp_;
        for (std::size_t n = 0; n < spare.count; ++n)
        {
            const Vec3 d = points_[spare.index[n]] - place;
            const double squared = dot(d, d);
            if (squared < limit) body(spare.index[n], d, squared);
        }
    }

private:
    // Cells go by a linear form of their numbers, so that the eight around a place never share a
    // slot; what else shares one costs time, not correctness.
    static constexpr std::size_t slot_count = 1u << 14;
    static constexpr std::uint32_t none = 0xFFFFFFFF;

    struct Block
    {
        static constexpr std::uint32_t capacity = 16;
        std::array<float, capacity> x, y, z; ///< dp from the origin; far away where nothing is yet
        std::array<std::uint32_t, capacity> index{};
        std::uint32_t count = 0;
        std::uint32_t next = none;

        Block()
        {
            x.fill(far_away_dp);
            y.fill(0);
            z.fill(0);
        }
    };

    static std::size_t slot_of(std::int64_t i, std::int64_t j, std::int64_t k)
    {
        return static_cast<std::size_t>(i * 4421 + j * 67 + k) & (slot_count - 1);
    }
    static std::int64_t cell_of(double x)
    {
        // Truncation after a shift that makes all coordinates positive: faster than floor().
        return static_cast<std::int64_t>(x * (0.5 / reach) + 1048576.0);
    }
    Vec3 in_dp(const Vec3& point) const { return (point - origin_) * per_dp_; }

    double dp_ = 1;
    double per_dp_ = 1;
    Vec3 origin_;
    std::vector<Vec3> points_;
    std::vector<std::uint32_t> heads_; ///< per slot: its first block
    std::vector<std::uint32_t> used_;  ///< slots with a block
    std::vector<Block> blocks_;
};

/// The point nearest to a place at `shift` (dp) from the middle of the list.
NearestPoint nearest_to(const NearPoints& near, const Vec3& shift);

/// The same for eight places at once.
NearestPoints nearest_to_each(const NearPoints& near, const EightNumbers& x, const EightNumbers& y,
                              const EightNumbers& z);

} // namespace fppg
