// The container is described at the head of src/files/bi4.cpp. Order of values and arrays does not
// matter to a reader, so all items are walked and the arrays wanted are picked by name.

#include "core/file_map.h"
#include "core/parallel.h"
#include "files/particle_readers.h"
#include "fppg/error.h"

#include <fmt/format.h>
#include <cstring>
#include <string_view>

namespace fppg
{

namespace
{

constexpr std::size_t head_size = 64;
constexpr std::size_t particles_a_chunk = 65536;

struct Bi4View
{
    std::string_view idp, pos, posd;
};

class Bi4Walk
{
public:
    Bi4Walk(std::string_view bytes, const std::string& path) : bytes_(bytes), path_(path)
    {
        const std::string_view title = "#FileJBD JPartDataBi4 ";
        if (bytes_.size() < head_size || bytes_.substr(0, title.size()) != title)
            fail("it does not begin as a particle file does (#FileJBD JPartDataBi4)");
        if (bytes_[60] % 10 != 0) fail("its byte order is not little-endian");
        has_64_bit_sizes_ = bytes_[61] != 0;
        at_ = head_size;
    }

    Bi4View walk()
    {
        walk_item(0);
        return view_;
    }

private:
    std::string_view bytes_;
    const std::string& path_;
    std::size_t at_ = 0;
    bool has_64_bit_sizes_ = false;
    Bi4View view_;

    [[noreturn]] void fail(const std::string& text) const
    {
        throw IoError(fmt::format("cannot read '{}': {}", path_, text));
    }
    std::string_view take(std::uint64_t size)
    {
        if (size > bytes_.size() - at_)
            fail(fmt::format("it ends at byte {}, but {} more are announced at byte {}",
                             bytes_.size(), size, at_));
        const std::string_view part = bytes_.substr(at_, size);
        at_ += size;
        return part;
    }
    template <typename T>
    T number()
    {
        T value;
        std::memcpy(&value, take(sizeof value).data(), sizeof value);
        return value;
    }
    std::string_view text() { return take(number<std::uint32_t>()); }
    std::uint64_t array_number()
    {
        return has_64_bit_sizes_ ? number<std::uint64_t>() : number<std::uint32_t>();
    }
    void expect_tag(std::string_view tag)
    {
        const std::size_t begin = at_;
        if (text() != tag) fail(fmt::format("the part at byte {} has another tag", begin));
    }

    void walk_item(int depth)
    {
        if (depth > 8) fail("its items are nested too deeply");
        number<std::uint32_t>(); // size of the definition
        expect_tag("\nITEM\n");
        text();  // name
        take(8); // hidden flags
        text();  // formats of numbers
        text();
        const auto arrays = number<std::uint32_t>();
        const auto items = number<std::uint32_t>();
        take(number<std::uint32_t>());
        for (std::uint32_t i = 0; i < arrays; ++i) walk_array();
        for (std::uint32_t i = 0; i < items; ++i) walk_item(depth + 1);
    }
    void walk_array()
    {
        number<std::uint32_t>();
        expect_tag("\nARRAY");
        const std::string_view name = text();
        number<std::int32_t>(); // hidden
        const auto type = number<std::int32_t>();
        const std::uint64_t count = array_number();
        const std::string_view data = take(array_number());
        const auto pick = [&](std::string_view wanted, int expected_type, std::uint64_t width,
                              std::string_view& place)
        {
            if (name != wanted) return;
            if (type != expected_type || data.size() % width != 0 || data.size() / width != count)
                fail(fmt::format("array {} has type {} and {} bytes for {} particles", name, type,
                                 data.size(), count));
            place = data;
        };
        pick("Idp", 8, 4, view_.idp);
        pick("Pos", 22, 12, view_.pos);
        pick("Posd", 23, 24, view_.posd);
    }
};

template <typename T>
void copy_positions(std::string_view data, std::vector<Vec3>& positions, int threads)
{
    const auto copy = [&](std::size_t i)
    {
        T p[3];
        std::memcpy(p, data.data() + i * sizeof p, sizeof p);
        positions[i] = {p[0], p[1], p[2]};
    };
    parallel_for(positions.size(), threads, copy, particles_a_chunk);
}

} // namespace

void read_bi4(const std::string& path, ParticleCloud& cloud, std::vector<std::uint32_t>& idp,
              int threads)
{
    const FileMap file(path);
    const Bi4View view = Bi4Walk(file.bytes(), path).walk();
    const std::size_t n = view.idp.size() / 4;
    // Where a file has both, the solver takes the single ones too.
    const bool is_single = view.posd.empty() || !view.pos.empty();
    const std::size_t n_positions = is_single ? view.pos.size() / 12 : view.posd.size() / 24;
    if (n_positions != n)
        throw IoError(
            fmt::format("cannot read '{}': it has {} ids and {} positions", path, n, n_positions));
    idp.resize(n);
    if (n > 0) std::memcpy(idp.data(), view.idp.data(), 4 * n);
    cloud.positions.resize(n);
    if (is_single)
        copy_positions<float>(view.pos, cloud.positions, threads);
    else
        copy_positions<double>(view.posd, cloud.positions, threads);
}

} // namespace fppg
