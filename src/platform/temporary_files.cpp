#include "platform/temporary_files.h"

#include "platform/files.h"
#include "platform/processes.h"

#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <string_view>

namespace fppg
{

namespace
{

/// The places of the registry. A path is written only while its slot is Reserved and read by a
/// signal handler only while it is Live.
enum SlotState
{
    Free,
    Reserved,
    Live,
};
constexpr std::size_t longest_path = 4096;
struct Slot
{
    std::atomic<int> state{Free};
    std::array<char, longest_path> path{};
};
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler must not wait for a lock");
std::array<Slot, 1024> slots;

/// The process that a name `.<name>.part-<process id>` or with `-<number>` behind it tells of, or
/// 0.
int process_of(std::string_view name, std::string_view wanted, bool is_stem)
{
    constexpr std::string_view mark = ".part-";
    const std::size_t at = name.rfind(mark);
    if (at == std::string_view::npos || at < 1 || name.front() != '.') return 0;
    const std::string_view file = name.substr(1, at - 1);
    const bool is_wanted =
        file == wanted || (is_stem && file.size() > wanted.size() && file.starts_with(wanted) &&
                           (file[wanted.size()] == '.' || file[wanted.size()] == '_'));
    if (!is_wanted) return 0;
    const std::string_view number = name.substr(at + mark.size());
    int process = 0;
    const auto [end, error] =
        std::from_chars(number.data(), number.data() + number.size(), process);
    const std::string_view rest(end, static_cast<std::size_t>(number.end() - end));
    const bool is_number =
        rest.empty() || (rest[0] == '-' && rest.size() > 1 &&
                         rest.find_first_not_of("0123456789", 1) == std::string_view::npos);
    return error == std::errc() && is_number && process > 0 ? process : 0;
}

} // namespace

int register_temporary(const std::string& path)
{
    if (path.size() >= longest_path) return -1;
    for (std::size_t i = 0; i < slots.size(); ++i)
    {
        int expected = Free;
        if (!slots[i].state.compare_exchange_strong(expected, Reserved)) continue;
        std::memcpy(slots[i].path.data(), path.c_str(), path.size() + 1);
        slots[i].state.store(Live);
        return static_cast<int>(i);
    }
    return -1;
}

void unregister_temporary(int slot) noexcept
{
    if (slot >= 0) slots[static_cast<std::size_t>(slot)].state.store(Free);
}

void remove_temporary_files() noexcept
{
    const int saved_errno = errno;
    for (Slot& slot : slots)
        if (slot.state.load() == Live) remove_file(slot.path.data());
    errno = saved_errno;
}

void remove_dead_parts(const std::string& folder, const std::string& name, bool is_stem)
{
    const std::filesystem::path in(folder.empty() ? "." : folder);
    std::error_code failed;
    std::filesystem::directory_iterator entry(in, failed);
    for (; !failed && entry != std::filesystem::directory_iterator(); entry.increment(failed))
    {
        const std::string file = entry->path().filename().string();
        if (!file.starts_with('.')) continue;
        const int process = process_of(file, name, is_stem);
        if (process == 0 || !is_process_gone(process)) continue;
        // Where locks do not work, that a process of this machine is gone has to do.
        const std::string path = (std::filesystem::path(folder) / file).string();
        if (!is_locked(path)) remove_file(path.c_str());
    }
}

} // namespace fppg
