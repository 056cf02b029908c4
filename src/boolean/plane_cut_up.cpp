#include "boolean/plane_cut_up.h"

#include "core/predicates.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace fppg
{
namespace
{

/// The order in which points are added: rows of a coarse grid, every second one backwards, so that
/// each lies near the one before.
std::vector<std::uint32_t> walking_order(const std::vector<PlanePoint>& points, double x0,
                                         double y0, double size)
{
    const double rows = std::max(1.0, std::sqrt(static_cast<double>(points.size()) / 2));
    std::vector<std::pair<double, std::uint32_t>> keys(points.size());
    for (std::uint32_t i = 0; i < points.size(); ++i)
    {
        const double row = std::floor((points[i].y - y0) / size * rows);
        const double along = (points[i].x - x0) / size;
        const bool is_back = std::fmod(row, 2) != 0;
        keys[i] = {row * 2 + (is_back ? 1 - along : along), i};
    }
    std::sort(keys.begin(), keys.end());
    std::vector<std::uint32_t> order(points.size());
    for (std::size_t i = 0; i < keys.size(); ++i) order[i] = keys[i].second;
    return order;
}

} // namespace

PlaneTriangulation::PlaneTriangulation(std::vector<PlanePoint> points) : points_(std::move(points))
{
    first_outer_ = static_cast<std::uint32_t>(points_.size());
    PlanePoint low = points_.empty() ? PlanePoint{} : points_[0];
    PlanePoint high = low;
    for (const PlanePoint& p : points_)
    {
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    double size = std::max(high.x - low.x, high.y - low.y);
    if (!(size > 0)) size = 1;
    const std::vector<std::uint32_t> order = walking_order(points_, low.x, low.y, size);
    const double far = 20 * size;
    const PlanePoint middle{0.5 * (low.x + high.x), 0.5 * (low.y + high.y)};
    points_.push_back({middle.x - 1.7 * far, middle.y - far});
    points_.push_back({middle.x + 1.9 * far, middle.y - 1.1 * far});
    points_.push_back({middle.x + 0.1 * far, middle.y + 2 * far});
    place_.resize(points_.size());
    std::iota(place_.begin(), place_.end(), 0U);
    at_.assign(points_.size(), none);
    Triangle all;
    all.corners = {first_outer_, first_outer_ + 1, first_outer_ + 2};
    all.neighbours = {none, none, none};
    triangles_.reserve(2 * points_.size());
    triangles_.push_back(all);
    for (const std::uint32_t v : all.corners) at_[v] = 0;
    for (const std::uint32_t p : order) insert(p);
}

int PlaneTriangulation::turn(std::uint32_t a, std::uint32_t b, std::uint32_t c) const
{
    return orient2d(points_[a].x, points_[a].y, points_[b].x, points_[b].y, points_[c].x,
                    points_[c].y);
}

bool PlaneTriangulation::is_in_circle(const Triangle& t, std::uint32_t p) const
{
    const PlanePoint& d = points_[p];
    const auto row = [&](std::uint32_t v) {
        return PlanePoint{points_[v].x - d.x, points_[v].y - d.y};
    };
    const PlanePoint a = row(t.corners[0]), b = row(t.corners[1]), c = row(t.corners[2]);
    const double bc = b.x * c.y, cb = c.x * b.y, ca = c.x * a.y, ac = a.x * c.y, ab = a.x * b.y,
                 ba = b.x * a.y;
    const double aa = a.x * a.x + a.y * a.y, bb = b.x * b.x + b.y * b.y, cc = c.x * c.x + c.y * c.y;
    const double det = aa * (bc - cb) + bb * (ca - ac) + cc * (ab - ba);
    const double size = aa * (std::abs(bc) + std::abs(cb)) + bb * (std::abs(ca) + std::abs(ac)) +
                        cc * (std::abs(ab) + std::abs(ba));
    return det > 2e-15 * size; // no flip for what rounding may turn round
}

std::uint32_t PlaneTriangulation::locate(std::uint32_t p) const
{
    std::uint32_t t = last_;
    std::uint32_t from = none;
    for (std::size_t step = 0; step < 4 * triangles_.size() + 16; ++step)
    {
        const Triangle& tri = triangles_[t];
        std::uint32_t next = none;
        for (std::uint32_t s = 0; s < 3 && next == none; ++s)
            if (tri.neighbours[s] != none && tri.neighbours[s] != from &&
                turn(tri.corners[s], tri.corners[(s + 1) % 3], p) < 0)
                next = tri.neighbours[s];
        if (next == none) break;
        from = t;
        t = next;
    }
    const auto holds = [&](std::uint32_t at)
    {
        for (std::uint32_t s = 0; s < 3; ++s)
            if (turn(triangles_[at].corners[s], triangles_[at].corners[(s + 1) % 3], p) < 0)
                return false;
        return true;
    };
    if (holds(t)) return last_ = t;
    for (std::uint32_t at = 0; at < triangles_.size(); ++at)
        if (holds(at)) return last_ = at;
    return last_;
}

void PlaneTriangulation::set_neighbour(std::uint32_t t, std::uint32_t old, std::uint32_t now)
{
    if (t == none) return;
    for (std::uint32_t& n : triangles_[t].neighbours)
        if (n == old)
        {
            n = now;
            return;
        }
}

std::uint32_t PlaneTriangulation::side_of(std::uint32_t t, std::uint32_t corner) const
{
    const auto& c = triangles_[t].corners;
    return c[0] == corner ? 0U : c[1] == corner ? 1U : 2U;
}

void PlaneTriangulation::insert(std::uint32_t p)
{
    const std::uint32_t t = locate(p);
    const Triangle old = triangles_[t];
    std::uint32_t on = none;
    for (std::uint32_t s = 0; s < 3; ++s)
    {
        const PlanePoint& q = points_[old.corners[s]];
        if (q.x == points_[p].x && q.y == points_[p].y)
        {
            place_[p] = old.corners[s];
            return;
        }
        if (turn(old.corners[s], old.corners[(s + 1) % 3], p) == 0) on = s;
    }
    std::vector<Side> stack;
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c)
    {
        Triangle made;
        made.corners = {a, b, c};
        made.neighbours = {none, none, none};
        triangles_.push_back(made);
        return static_cast<std::uint32_t>(triangles_.size() - 1);
    };
    if (on == none)
    {
        const auto [a, b, c] = old.corners;
        const std::uint32_t t1 = add(b, c, p);
        const std::uint32_t t2 = add(c, a, p);
        triangles_[t].corners = {a, b, p};
        triangles_[t].neighbours = {old.neighbours[0], t1, t2};
        triangles_[t1].neighbours = {old.neighbours[1], t2, t};
        triangles_[t2].neighbours = {old.neighbours[2], t, t1};
        set_neighbour(old.neighbours[1], t, t1);
        set_neighbour(old.neighbours[2], t, t2);
        at_[a] = at_[b] = at_[p] = t;
        at_[c] = t1;
        stack = {{t, 0}, {t1, 0}, {t2, 0}};
    }
    else
    {
        // The point splits the side, and with it both triangles there.
        const std::uint32_t a = old.corners[on], b = old.corners[(on + 1) % 3],
                            c = old.corners[(on + 2) % 3];
        const std::uint32_t u = old.neighbours[on];
        const std::uint32_t bc = old.neighbours[(on + 1) % 3], ca = old.neighbours[(on + 2) % 3];
        const Triangle beyond = triangles_[u];
        const std::uint32_t k = side_of(u, b); // the side from b to a
        const std::uint32_t d = beyond.corners[(k + 2) % 3];
        const std::uint32_t ad = beyond.neighbours[(k + 1) % 3],
                            db = beyond.neighbours[(k + 2) % 3];
        const std::uint32_t t1 = add(b, c, p);
        const std::uint32_t u1 = add(a, d, p);
        triangles_[t].corners = {c, a, p};
        triangles_[u].corners = {d, b, p};
        triangles_[t].neighbours = {ca, u1, t1};
        triangles_[t1].neighbours = {bc, t, u};
        triangles_[u].neighbours = {db, t1, u1};
        triangles_[u1].neighbours = {ad, u, t};
        set_neighbour(bc, t, t1);
        set_neighbour(ad, u, u1);
        at_[a] = t;
        at_[c] = t;
        at_[p] = t;
        at_[b] = u;
        at_[d] = u;
        stack = {{t, 0}, {t1, 0}, {u, 0}, {u1, 0}};
    }
    last_ = t;
    legalise(stack);
}

/// Turns the side between two triangles into the other diagonal of their quad.
void PlaneTriangulation::flip(std::uint32_t t, std::uint32_t side)
{
    const Triangle one = triangles_[t];
    const std::uint32_t u = one.neighbours[side];
    const Triangle two = triangles_[u];
    const std::uint32_t a = one.corners[side], b = one.corners[(side + 1) % 3],
                        c = one.corners[(side + 2) % 3];
    const std::uint32_t k = side_of(u, b);
    const std::uint32_t d = two.corners[(k + 2) % 3];
    const std::uint32_t s1 = (side + 1) % 3, s2 = (side + 2) % 3, k1 = (k + 1) % 3,
                        k2 = (k + 2) % 3;
    triangles_[t].corners = {c, a, d};
    triangles_[t].neighbours = {one.neighbours[s2], two.neighbours[k1], u};
    triangles_[t].is_fixed = {one.is_fixed[s2], two.is_fixed[k1], 0};
    triangles_[u].corners = {d, b, c};
    triangles_[u].neighbours = {two.neighbours[k2], one.neighbours[s1], t};
    triangles_[u].is_fixed = {two.is_fixed[k2], one.is_fixed[s1], 0};
    set_neighbour(two.neighbours[k1], u, t);
    set_neighbour(one.neighbours[s1], t, u);
    at_[a] = at_[c] = at_[d] = t;
    at_[b] = u;
}

void PlaneTriangulation::legalise(std::vector<Side>& stack)
{
    std::size_t flips = 0;
    const std::size_t limit = 64 * triangles_.size() + 256;
    while (!stack.empty() && flips < limit)
    {
        const auto [t, s] = stack.back();
        stack.pop_back();
        const Triangle& tri = triangles_[t];
        const std::uint32_t u = tri.neighbours[s];
        if (u == none || tri.is_fixed[s] != 0) continue;
        const std::uint32_t a = tri.corners[s], b = tri.corners[(s + 1) % 3],
                            c = tri.corners[(s + 2) % 3];
        const std::uint32_t d = triangles_[u].corners[(side_of(u, b) + 2) % 3];
        if (!is_in_circle(tri, d)) continue;
        if (turn(c, a, d) <= 0 || turn(d, b, c) <= 0) continue;
        flip(t, s);
        ++flips;
        stack.push_back({t, 0});
        stack.push_back({t, 1});
        stack.push_back({u, 0});
        stack.push_back({u, 1});
    }
}

PlaneTriangulation::Side PlaneTriangulation::find_side(std::uint32_t a, std::uint32_t b) const
{
    if (a >= first_outer_ && b < first_outer_)
    {
        // The triangles around an outer point do not close; those around the other one do.
        const Side back = find_side(b, a);
        if (back.triangle == none) return back;
        const std::uint32_t across = triangles_[back.triangle].neighbours[back.side];
        return {across, across == none ? 0 : side_of(across, a)};
    }
    const std::uint32_t first = at_[a];
    std::uint32_t t = first;
    do
    {
        const std::uint32_t s = side_of(t, a);
        if (triangles_[t].corners[(s + 1) % 3] == b) return {t, s};
        t = triangles_[t].neighbours[(s + 2) % 3];
    } while (t != first && t != none);
    return {none, 0};
}

bool PlaneTriangulation::fix(std::uint32_t a, std::uint32_t b)
{
    const Side one = find_side(a, b);
    const Side two = find_side(b, a);
    if (one.triangle != none) triangles_[one.triangle].is_fixed[one.side] = 1;
    if (two.triangle != none) triangles_[two.triangle].is_fixed[two.side] = 1;
    return one.triangle != none || two.triangle != none;
}

PlaneTriangulation::Way PlaneTriangulation::way_from(std::uint32_t a, std::uint32_t b) const
{
    const auto lies_ahead = [&](std::uint32_t v)
    {
        const double dx = points_[b].x - points_[a].x, dy = points_[b].y - points_[a].y;
        return (points_[v].x - points_[a].x) * dx + (points_[v].y - points_[a].y) * dy > 0;
    };
    Way way;
    const std::uint32_t first = at_[a];
    std::uint32_t t = first;
    do
    {
        const std::uint32_t s = side_of(t, a);
        const std::uint32_t r = triangles_[t].corners[(s + 1) % 3],
                            l = triangles_[t].corners[(s + 2) % 3];
        const int right = turn(a, b, r), left = turn(a, b, l);
        if (right == 0 && lies_ahead(r)) way.point = r;
        if (right < 0 && left > 0) way.triangle = t;
        if (way.point != none || way.triangle != none) break;
        t = triangles_[t].neighbours[(s + 2) % 3];
    } while (t != first && t != none);
    return way;
}

bool PlaneTriangulation::list_crossed(std::uint32_t a, std::uint32_t b, std::uint32_t t,
                                      Crossed& out) const
{
    out.end = b;
    std::uint32_t s = (side_of(t, a) + 1) % 3;
    for (std::size_t step = 0; step <= triangles_.size(); ++step)
    {
        const Triangle& tri = triangles_[t];
        if (tri.is_fixed[s] != 0) return false;
        out.sides.emplace_back(tri.corners[s], tri.corners[(s + 1) % 3]);
        const std::uint32_t u = tri.neighbours[s];
        if (u == none) return false;
        const std::uint32_t k = side_of(u, tri.corners[(s + 1) % 3]);
        const std::uint32_t far = triangles_[u].corners[(k + 2) % 3];
        if (far == b) break;
        const int side = turn(a, b, far);
        if (side == 0)
        {
            out.end = far;
            break;
        }
        // Side k runs from right to left seen from u: the one behind `far` comes next.
        s = side > 0 ? (k + 1) % 3 : (k + 2) % 3;
        t = u;
    }
    return true;
}

bool PlaneTriangulation::flip_crossed(std::uint32_t a, Crossed crossed)
{
    const std::uint32_t end = crossed.end;
    auto& sides = crossed.sides;
    std::size_t tries = 0;
    const std::size_t limit = 64 * sides.size() * sides.size() + 4096;
    for (std::size_t i = 0; i < sides.size() && tries < limit; ++i, ++tries)
    {
        const auto [p, q] = sides[i];
        const Side at = find_side(p, q);
        if (at.triangle == none) continue;
        const Triangle& tri = triangles_[at.triangle];
        const std::uint32_t c = tri.corners[(at.side + 2) % 3];
        const std::uint32_t u = tri.neighbours[at.side];
        if (u == none) return false;
        const std::uint32_t d = triangles_[u].corners[(side_of(u, q) + 2) % 3];
        if (turn(c, p, d) <= 0 || turn(d, q, c) <= 0)
        {
            sides.emplace_back(p, q); // not convex: after the others
            continue;
        }
        flip(at.triangle, at.side);
        const bool crosses_still =
            c != a && c != end && d != a && d != end && turn(a, end, c) * turn(a, end, d) < 0;
        if (crosses_still) sides.emplace_back(c, d);
    }
    return true;
}

bool PlaneTriangulation::add_constraint(std::uint32_t a, std::uint32_t b)
{
    a = place_[a];
    b = place_[b];
    while (a != b)
    {
        if (fix(a, b)) return true;
        const Way way = way_from(a, b);
        if (way.point != none)
        {
            if (!fix(a, way.point)) return false;
            a = way.point;
            continue;
        }
        Crossed crossed;
        if (way.triangle == none || !list_crossed(a, b, way.triangle, crossed)) return false;
        const std::uint32_t end = crossed.end;
        if (!flip_crossed(a, std::move(crossed)) || !fix(a, end)) return false;
        a = end;
    }
    return true;
}

} // namespace fppg
