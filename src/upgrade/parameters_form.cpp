#include "upgrade/edited_text.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string_view>

namespace fppg
{
namespace
{

/// The parameters of `<execution>` that the solver of v5.4 calls deprecated, by what its source
/// makes of them.
class ParameterUpgrade
{
public:
    ParameterUpgrade(const TextNode& parameters, EditedText& edited)
        : parameters_(parameters), edited_(edited)
    {
    }

    void run()
    {
        upgrade_double_positions();
        upgrade_delta_sph();
        upgrade_parts_out();
        upgrade_domain();
    }

private:
    /// The one of that key, or nullptr; one switched off does not count.
    const TextNode* find(std::string_view key) const
    {
        for (const TextNode* p : active_children(parameters_, "parameter"))
        {
            const TextAttribute* k = p->find_attribute("key");
            if (k != nullptr && k->value == key && is_switched_on(*p) &&
                p->find_attribute("value") != nullptr)
                return p;
        }
        return nullptr;
    }

    /// An old one, which must be there once: of two the solver takes the last value.
    const TextNode* find_old(std::string_view key)
    {
        const TextNode* found = find(key);
        if (found == nullptr) return nullptr;
        std::size_t count = 0;
        for (const TextNode* p : active_children(parameters_, "parameter"))
            if (const TextAttribute* k = p->find_attribute("key"); k != nullptr && k->value == key)
                ++count;
        if (count == 1) return found;
        edited_.note(found->line, fmt::format("{} is given {} times; keep one", key, count));
        return nullptr;
    }

    static const std::string& value_of(const TextNode& p)
    {
        return p.find_attribute("value")->value;
    }
    static std::string told(std::string_view key, std::string_view value)
    {
        return fmt::format("{}=\"{}\"", key, value);
    }
    static std::string told(const TextNode& p)
    {
        return told(p.find_attribute("key")->value, value_of(p));
    }

    void note_expression(const TextNode& p)
    {
        edited_.note(p.line, told(p) + " is no plain number and is left as it is");
    }

    /// Gives a parameter another key, value and, where it has one, comment.
    void set(const TextNode& p, const std::string& key, const std::string& value,
             const std::string& comment)
    {
        edited_.replace(p.find_attribute("key")->value_at, key);
        edited_.replace(p.find_attribute("value")->value_at, value);
        if (const TextAttribute* c = p.find_attribute("comment"))
            edited_.replace(c->value_at, comment);
    }

    void switch_off(const TextNode& p)
    {
        edited_.rename(p, "_parameter");
        edited_.report(p.line, told(p), "<_parameter>, for it has no effect");
    }

    /// PosDouble: 2 saved positions in double precision; SavePosDouble overrules it.
    void upgrade_double_positions()
    {
        const TextNode* p = find_old("PosDouble");
        if (p == nullptr) return;
        if (find("SavePosDouble") != nullptr)
        {
            switch_off(*p);
            return;
        }
        const auto mode = literal_number(value_of(*p));
        if (!mode)
        {
            note_expression(*p);
            return;
        }
        const std::string value = *mode == 2 ? "1" : "0";
        edited_.report(p->line, told(*p), told("SavePosDouble", value));
        set(*p, "SavePosDouble", value, "Saves positions in double precision (default=0)");
    }

    /// DeltaSPH: above 0 the factor of Molteni's density diffusion; not together with DensityDT.
    void upgrade_delta_sph()
    {
        const TextNode* p = find_old("DeltaSPH");
        if (p == nullptr) return;
        const auto factor = literal_number(value_of(*p));
        if (find("DensityDT") != nullptr)
            edited_.note(p->line, "DeltaSPH: v5.4's solver refuses it together with DensityDT");
        else if (!factor)
            note_expression(*p);
        else if (*factor > 0)
            set_density_diffusion(*p);
        else
        {
            edited_.report(p->line, told(*p), told("DensityDT", "0"));
            set(*p, "DensityDT", "0", diffusion_comment);
        }
    }

    void set_density_diffusion(const TextNode& p)
    {
        const std::string factor = value_of(p);
        edited_.report(p.line, told(p),
                       told("DensityDT", "1") + " " + told("DensityDTvalue", factor));
        if (const TextNode* given = find("DensityDTvalue"))
            edited_.replace(given->find_attribute("value")->value_at, factor);
        else
        {
            // A second parameter behind the first, written alike.
            std::string second = edited_.part(p.whole);
            const auto put = [&](std::string_view name, const std::string& value)
            {
                if (const TextAttribute* a = p.find_attribute(name))
                    second.replace(a->value_at.begin - p.whole.begin,
                                   a->value_at.end - a->value_at.begin, value);
            };
            // From the back, so that the places before stay; which of the two is first differs.
            const TextAttribute* key = p.find_attribute("key");
            const TextAttribute* comment = p.find_attribute("comment");
            const bool comment_first =
                comment != nullptr && comment->whole.begin < key->whole.begin;
            if (!comment_first) put("comment", "Factor of the density diffusion (default=0.1)");
            put("key", "DensityDTvalue");
            if (comment_first) put("comment", "Factor of the density diffusion (default=0.1)");
            const auto indent = edited_.indent_at(p.whole.begin);
            edited_.insert(p.whole.end,
                           indent ? edited_.line_end(p.whole.end) + *indent + second : second);
        }
        set(p, "DensityDT", "1", diffusion_comment);
    }

    /// PartsOutMax: v5.4 does not look at it. 1, all of the fluid, is what MinFluidStop does at 0.
    void upgrade_parts_out()
    {
        const TextNode* p = find_old("PartsOutMax");
        if (p == nullptr) return;
        if (find("MinFluidStop") != nullptr)
        {
            switch_off(*p);
            return;
        }
        const auto share = literal_number(value_of(*p));
        if (share && *share == 1)
        {
            edited_.report(p->line, told(*p), told("MinFluidStop", "0"));
            set(*p, "MinFluidStop", "0",
                "The run stops when less than this part of the fluid is left, 0: never "
                "(default=0)");
        }
        else
            edited_.note(
                p->line,
                fmt::format("{}: v5.4 does not look at it; MinFluidStop took its place{}", told(*p),
                            share
                                ? fmt::format(", and {} stops a run where this one meant to stop",
                                              told("MinFluidStop", fmt::format("{:g}", 1 - *share)))
                                : ""));
    }

    /// The limits of the domain by keys, which `<simulationdomain>` replaces.
    void upgrade_domain()
    {
        for (const TextNode* p : active_children(parameters_, "parameter"))
            if (const TextAttribute* key = p->find_attribute("key");
                key != nullptr && key->value.starts_with("DomainParticles"))
                edited_.note(p->line, fmt::format("{}: v5.4 does not look at it; "
                                                  "<simulationdomain> gives such limits, as in "
                                                  "x=\"default + 0.5\"",
                                                  key->value));
        std::vector<const TextNode*> old;
        if (!read_limits(old) || old.empty()) return;
        const TextNode* domain = parameters_.find("simulationdomain");
        if (domain != nullptr)
            set_limits(*domain, old);
        else
            replace_by_domain(old);
    }

    /// False where one of them cannot be told in the new form, which is noted.
    bool read_limits(std::vector<const TextNode*>& old)
    {
        if (const TextNode* p = find_old("IncZ"))
        {
            const auto part = literal_number(value_of(*p));
            if (!part || *part < 0)
            {
                note_expression(*p);
                return false;
            }
            if (*part == 0)
                switch_off(*p);
            else
            {
                limits_[5] = fmt::format("default + {:.10g}%", *part * 100);
                old.push_back(p);
            }
        }
        if (const TextNode* p = find_old("DomainFixed"))
        {
            // It puts aside what IncZ said.
            if (!read_six(value_of(*p)))
            {
                edited_.note(p->line, told(*p) + ": expected six numbers between colons");
                return false;
            }
            old.push_back(p);
        }
        static constexpr std::string_view keys[] = {"DomainFixedXmin", "DomainFixedYmin",
                                                    "DomainFixedZmin", "DomainFixedXmax",
                                                    "DomainFixedYmax", "DomainFixedZmax"};
        for (std::size_t i = 0; i < 6; ++i)
            if (const TextNode* p = find_old(keys[i]))
            {
                if (!literal_number(value_of(*p)))
                {
                    note_expression(*p);
                    return false;
                }
                limits_[i] = value_of(*p);
                old.push_back(p);
            }
        return true;
    }

    bool read_six(const std::string& text)
    {
        std::size_t at = 0;
        for (std::size_t i = 0; i < 6; ++i)
        {
            const std::size_t end = std::min(text.find(':', at), text.size());
            limits_[i] = text.substr(at, end - at);
            if (!literal_number(limits_[i])) return false;
            at = std::min(end + 1, text.size());
        }
        return at == text.size();
    }

    /// Into the attributes of a domain that leaves all limits as they come.
    void set_limits(const TextNode& domain, const std::vector<const TextNode*>& old)
    {
        const TextNode* points[] = {domain.find("posmin"), domain.find("posmax")};
        bool can_set = true;
        for (std::size_t i = 0; i < 6; ++i)
        {
            const TextNode* point = points[i / 3];
            const TextAttribute* a =
                point == nullptr ? nullptr : point->find_attribute(axes[i % 3]);
            can_set = can_set && a != nullptr && a->value == "default";
        }
        if (!can_set)
        {
            edited_.note(old.front()->line,
                         told(*old.front()) +
                             ": v5.4's solver refuses it together with limits in "
                             "<simulationdomain>");
            return;
        }
        for (std::size_t i = 0; i < 6; ++i)
            if (limits_[i] != "default")
                edited_.replace(points[i / 3]->find_attribute(axes[i % 3])->value_at, limits_[i]);
        for (const TextNode* p : old)
        {
            edited_.remove(*p);
            edited_.report(p->line, told(*p), told_domain());
        }
    }

    /// `<simulationdomain>` in the place of the first of them.
    void replace_by_domain(const std::vector<const TextNode*>& old)
    {
        for (const TextNode* p : old)
        {
            if (p != old.front()) edited_.remove(*p);
            edited_.report(p->line, told(*p), told_domain());
        }
        const auto indent = edited_.indent_at(old.front()->whole.begin);
        const std::string line =
            indent ? edited_.line_end(old.front()->whole.end) + *indent : std::string();
        const std::string step = indent ? edited_.indent_step(parameters_) : std::string();
        edited_.replace(old.front()->whole, "<simulationdomain>" + line + step +
                                                point("posmin", 0) + line + step +
                                                point("posmax", 3) + line + "</simulationdomain>");
    }

    std::string point(const char* name, std::size_t first) const
    {
        return fmt::format("<{} x=\"{}\" y=\"{}\" z=\"{}\" />", name, limits_[first],
                           limits_[first + 1], limits_[first + 2]);
    }

    std::string told_domain() const
    {
        return "<simulationdomain> " + point("posmin", 0) + " " + point("posmax", 3);
    }

    static constexpr const char* diffusion_comment =
        "Density diffusion 0: none, 1: Molteni, 2: Fourtakas, 3: Fourtakas with boundaries "
        "(default=0)";
    static constexpr std::string_view axes[] = {"x", "y", "z"};

    const TextNode& parameters_;
    EditedText& edited_;
    std::array<std::string, 6> limits_{"default", "default", "default",
                                       "default", "default", "default"}; ///< posmin, posmax
};

} // namespace

void upgrade_parameters(const TextNode& root, EditedText& edited)
{
    if (const TextNode* parameters = find_active(root, "execution/parameters"))
        ParameterUpgrade(*parameters, edited).run();
}

} // namespace fppg
