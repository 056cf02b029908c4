#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace fppg
{

/// A point of a plane.
struct PlanePoint
{
    double x = 0;
    double y = 0;
};

/// A constrained triangulation of points in a plane. It covers a triangle far around them, whose
/// corners are the three points behind the given ones.
///
/// Exact predicates decide all sides, so that it is a valid triangulation whatever the points; it
/// is that of Delaunay but for rounding and constraints.
///
/// Source: C. L. Lawson, Software for C1 surface interpolation, 1977 (points by flips); S. W.
/// Sloan, A fast algorithm for generating constrained Delaunay triangulations, 1993.
class PlaneTriangulation
{
public:
    struct Triangle
    {
        std::array<std::uint32_t, 3> corners;    ///< counter-clockwise
        std::array<std::uint32_t, 3> neighbours; ///< across the side from corner s to s + 1
        std::array<char, 3> is_fixed{0, 0, 0};   ///< the side is a constraint
    };

    /// points  any; of points in one place the first one stands for all
    explicit PlaneTriangulation(std::vector<PlanePoint> points);

    /// Makes a side from a to b, or several where points lie on the way.
    ///
    /// returns  false, and adds nothing from there on, where another constraint is in the way
    bool add_constraint(std::uint32_t a, std::uint32_t b);

    /// The point that stands for point i.
    std::uint32_t place_of(std::uint32_t i) const { return place_[i]; }
    const std::vector<Triangle>& triangles() const { return triangles_; }
    /// Points from here on are the corners of the triangle around all.
    std::uint32_t first_outer() const { return first_outer_; }

private:
    static constexpr std::uint32_t none = UINT32_MAX; ///< no point, no triangle
    struct Side
    {
        std::uint32_t triangle;
        std::uint32_t side;
    };

    /// Where the way from a point to another leads first: to a point on it, or through a triangle.
    struct Way
    {
        std::uint32_t point = none;
        std::uint32_t triangle = none;
    };
    /// Sides, from right to left, that the way from a point to `end` crosses.
    struct Crossed
    {
        std::vector<std::pair<std::uint32_t, std::uint32_t>> sides;
        std::uint32_t end = none;
    };

    /// Fixes the side from a to b; false if there is none.
    bool fix(std::uint32_t a, std::uint32_t b);
    Way way_from(std::uint32_t a, std::uint32_t b) const;
    /// The sides from a through triangle t on to b, or to a point before it. False where one is
    /// fixed.
    bool list_crossed(std::uint32_t a, std::uint32_t b, std::uint32_t t, Crossed& out) const;
    /// Flips sides until there is one from a to the end.
    bool flip_crossed(std::uint32_t a, Crossed crossed);
    int turn(std::uint32_t a, std::uint32_t b, std::uint32_t c) const;
    bool is_in_circle(const Triangle& t, std::uint32_t p) const;
    std::uint32_t locate(std::uint32_t p) const;
    void insert(std::uint32_t p);
    void link(std::uint32_t t, std::uint32_t side, std::uint32_t to, std::uint32_t from_side);
    void set_neighbour(std::uint32_t t, std::uint32_t old, std::uint32_t now);
    void flip(std::uint32_t t, std::uint32_t side);
    void legalise(std::vector<Side>& stack);
    std::uint32_t side_of(std::uint32_t t, std::uint32_t corner) const;
    /// The triangle with a side from a to b; no triangle without one.
    Side find_side(std::uint32_t a, std::uint32_t b) const;

    std::vector<PlanePoint> points_;
    std::vector<Triangle> triangles_;
    std::vector<std::uint32_t> place_;
    std::vector<std::uint32_t> at_; ///< per point a triangle that has it as a corner
    std::uint32_t first_outer_ = 0;
    mutable std::uint32_t last_ = 0; ///< where the search for a point begins
};

} // namespace fppg
