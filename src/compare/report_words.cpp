#include "compare/report_words.h"

#include <fmt/format.h>

namespace fppg
{

namespace
{

std::string place(const Vec3& p)
{
    return fmt::format("({:.9g}, {:.9g}, {:.9g})", p.x, p.y, p.z);
}

} // namespace

const char* particle_type_name(int type)
{
    static constexpr const char* names[] = {"fixed", "moving", "floating", "fluid"};
    return type >= 0 && type < 4 ? names[type] : "-";
}

const char* change_name(ChangeKind kind)
{
    static constexpr const char* names[] = {"missing",  "extra",   "moved",    "other mk",
                                            "other id", "density", "velocity", "normal"};
    return names[static_cast<std::size_t>(kind)];
}

std::string describe_change(const ChangedParticle& p)
{
    std::string from = fmt::format("id {} at {}", p.id[0], place(p.position[0]));
    switch (p.kind)
    {
        case ChangeKind::Missing:
            return from;
        case ChangeKind::Extra:
            return fmt::format("id {} at {}", p.id[1], place(p.position[1]));
        case ChangeKind::Moved:
            return fmt::format("{} is id {} at {}, {:.4g} dp away", from, p.id[1],
                               place(p.position[1]), p.size);
        case ChangeKind::MkChanged:
            return fmt::format("{} has mk {} in A, mk {} in B", from, p.mk[0], p.mk[1]);
        case ChangeKind::IdChanged:
            return fmt::format("{} is id {} in B", from, p.id[1]);
        default:
            return fmt::format("{} differs by {:.4g}", from, p.size);
    }
}

} // namespace fppg
