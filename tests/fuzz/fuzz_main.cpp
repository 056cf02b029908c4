// All targets in one libFuzzer program; FPPG_FUZZ_TARGET names the one that runs.
#include "fuzz/mutate_case.h"
#include "fuzz/targets.h"
#include "fuzz/working_folder.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);

namespace
{

const fppg::fuzz::Target* chosen = nullptr;

/// The new size; 0 where the text does not fit.
std::size_t put_text(const std::string& text, std::uint8_t* out, std::size_t most)
{
    if (text.empty() || text.size() > most) return 0;
    std::memcpy(out, text.data(), text.size());
    return text.size();
}

} // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***)
{
    const char* name = std::getenv("FPPG_FUZZ_TARGET");
    chosen = fppg::fuzz::find_target(name == nullptr ? "" : name);
    if (chosen == nullptr)
    {
        std::fprintf(stderr, "FPPG_FUZZ_TARGET names no target; there are:");
        for (const fppg::fuzz::Target& target : fppg::fuzz::targets())
            std::fprintf(stderr, " %s", std::string(target.name).c_str());
        std::fprintf(stderr, "\n");
        std::exit(2);
    }
    fppg::fuzz::enter_working_folder();
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    fppg::fuzz::run_target(*chosen, {reinterpret_cast<const char*>(data), size});
    return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned seed)
{
    // Reading is also tried with bytes that are no XML.
    const bool by_bytes = !chosen->is_case || (chosen->name == "case" && seed % 3 == 0);
    if (!by_bytes)
    {
        const std::string text(reinterpret_cast<const char*>(data), size);
        if (const std::size_t n = put_text(fppg::fuzz::mutate_case(text, seed), data, most))
            return n;
    }
    return LLVMFuzzerMutate(data, size, most);
}

extern "C" std::size_t LLVMFuzzerCustomCrossOver(const std::uint8_t* first, std::size_t first_size,
                                                 const std::uint8_t* second,
                                                 std::size_t second_size, std::uint8_t* out,
                                                 std::size_t most, unsigned seed)
{
    const std::string a(reinterpret_cast<const char*>(first), first_size);
    const std::string b(reinterpret_cast<const char*>(second), second_size);
    if (chosen->is_case) return put_text(fppg::fuzz::cross_cases(a, b, seed), out, most);
    // Head of one and tail of the other.
    const std::size_t cut = a.empty() ? 0 : seed % a.size();
    const std::size_t from = b.empty() ? 0 : (seed / 7) % b.size();
    return put_text((a.substr(0, cut) + b.substr(from)).substr(0, most), out, most);
}
