#pragma once

#include <span>
#include <string_view>

namespace fppg::fuzz
{

/// A reader, or a stage, that gets bytes of anybody. It returns or throws fppg::Error; anything
/// else is a fault: another exception, a crash, a hang, gigabytes for a small file.
struct Target
{
    std::string_view name;
    void (*run)(std::string_view bytes);
    bool is_case; ///< its inputs are case definitions, which the fuzzer changes by their grammar
};

std::span<const Target> targets();

/// nullptr: there is none of this name.
const Target* find_target(std::string_view name);

/// Runs a target; a refusal is a good end.
void run_target(const Target& target, std::string_view bytes);

/// The particles of a small definition (generate_target.cpp).
void generate_particles(std::string_view bytes);

} // namespace fppg::fuzz
