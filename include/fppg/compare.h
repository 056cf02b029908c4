#pragma once

#include "fppg/error.h"
#include "fppg/mesh.h"
#include "fppg/read_particles.h"
#include "fppg/vec.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace fppg
{

/// Two results cannot be compared; the text says which file, and why.
class CompareError : public Error
{
public:
    using Error::Error;
    int exit_code() const override { return 2; }
};

/// What counts as equal, and how much memory is used. The defaults are those of the recorded cases.
struct CompareOptions
{
    /// Two particles are at the same place within this, dp, 0 to 0.5. Where a file holds float32
    /// positions, what they round is added.
    double same_place_dp = 1e-6;
    double density = 2e-6;             ///< relative
    double velocity = 1e-5;            ///< m/s; 1e-6 of the velocity is added
    double normal_dp = 1e-4;           ///< dp
    double constants = 1e-5;           ///< relative; GenCase prints six digits
    double constants_bi4 = 1e-9;       ///< relative, of the values in Case.bi4
    std::vector<std::string> geometry; ///< mesh files, in the place of the particles; metres
    TriangleSoup surface;              ///< more of it
    /// Particles of both files held in memory at once, at least 1.
    std::uint64_t particles_at_once = std::uint64_t{16} << 20;
    std::size_t examples = 5;        ///< of each kind of difference, at most
    std::size_t changed_at_most = 0; ///< particles kept in Comparison::changed; 0: none
    int threads = 1;
};

/// Numbers of one kind, summed exactly: neither order nor blocks nor threads change a bit.
struct Statistics
{
    static constexpr std::size_t bins = 60;

    std::uint64_t count = 0;
    double mean = 0;
    double deviation = 0; ///< standard deviation
    double least = 0;
    double largest = 0;
    /// Numbers in [histogram_begin, histogram_end); smaller ones are in the first bin, larger ones
    /// in the last.
    std::array<std::uint64_t, bins> histogram{};
};

/// An array at particles that both files have.
struct ArrayDifference
{
    std::uint64_t differing = 0;
    double largest = 0; ///< of the absolute difference; normals in dp, else SI
};

/// One mk of both files. `count[0]` of A is same + moved + missing + mk_changed; `count[1]` of B
/// is same + moved + extra + mk_gained.
struct MkComparison
{
    std::uint16_t mk = 0;
    std::array<int, 2> type{-1, -1}; ///< as ParticleType; -1: none, or the file does not say
    std::array<std::uint64_t, 2> count{};
    std::uint64_t same = 0;                ///< at the same place
    std::uint64_t moved = 0;               ///< within dp of a particle of B
    std::uint64_t missing = 0;             ///< in A only
    std::uint64_t extra = 0;               ///< in B only
    std::uint64_t mk_changed = 0;          ///< of A, with another mk at the same place in B
    std::uint64_t mk_gained = 0;           ///< of B, with another mk at the same place in A
    std::uint64_t id_changed = 0;          ///< same or moved, with another id
    Statistics moved_dp;                   ///< distances, (0, 1]
    std::array<Statistics, 2> spacing_dp;  ///< to the nearest particle of any mk
    std::array<std::uint64_t, 2> alone{};  ///< without one within 2.6 dp, not in the statistics
    std::array<Statistics, 2> shepard;     ///< sum of W dp^3 (W dp^2 in 2-D) over all particles
    std::array<Statistics, 2> distance_dp; ///< to the geometry, where within 2 dp of it
    ArrayDifference density, velocity, normal;
};

enum class ChangeKind : std::uint8_t
{
    Missing,
    Extra,
    Moved,
    MkChanged,
    IdChanged,
    Density,
    Velocity,
    Normal,
};

/// A particle, or a pair, that differs.
struct ChangedParticle
{
    ChangeKind kind = ChangeKind::Missing;
    double size = 0;                      ///< distance in dp, or absolute difference
    std::array<std::uint32_t, 2> index{}; ///< in A, in B; not used where it is not there
    std::array<std::uint32_t, 2> id{};
    std::array<std::uint16_t, 2> mk{};
    std::array<Vec3, 2> position;
};

/// A difference as one sentence.
struct Finding
{
    double size = 0; ///< share of the particles, or relative difference: 0 to 1
    std::string category;
    std::string text;
};

struct ValueDifference
{
    std::string place; ///< as "execution/constants/dp@value" or "Case.bi4 Dp"
    std::optional<std::string> a, b;
    double size = 0; ///< relative difference of numbers; 1 where one is missing or is no number
    bool is_constant = false;
};

struct ComparedFile
{
    std::string path;
    std::string app_name; ///< of its maker, as the file says; may be empty
    std::string date;
    double dp = 0; ///< metres
    std::uint64_t np = 0;
    Box3 bounds;
};

/// A stretch of numbers, cut into Statistics::bins.
struct HistogramRange
{
    double begin = 0;
    double end = 0;
};
inline constexpr HistogramRange moved_range{0, 1};
inline constexpr HistogramRange spacing_range{0, 1.5};
inline constexpr HistogramRange shepard_range{0, 1.5};
inline constexpr HistogramRange distance_range{0, 2};

struct Comparison
{
    CompareOptions options;
    std::array<ComparedFile, 2> files;
    double dp = 0;           ///< metres; that of A, or of B where A does not say
    double same_place_m = 0; ///< metres
    bool is_2d = false;
    std::array<bool, 2> is_on_lattice{true, true}; ///< or body-fitted, wholly or in part
    bool has_geometry = false;                     ///< that distances are taken to
    std::vector<MkComparison> mks;                 ///< by mk
    std::vector<ValueDifference> values;   ///< of constants first, then in the order of Case.xml
    std::vector<Finding> findings;         ///< largest first
    std::vector<ChangedParticle> examples; ///< by kind, largest first
    /// Missing, extra, moved ones and those with another mk, those with the lowest index first
    /// where there are more than asked for.
    std::vector<ChangedParticle> changed;
    std::vector<std::string> notes; ///< what could not be compared, whole sentences
    std::size_t blocks = 0; ///< in which the particles were worked through; not part of a report

    bool is_equal() const { return findings.empty(); }
    /// One on the lattice and one body-fitted: their particles stand at other places by design.
    bool is_of_two_modes() const { return is_on_lattice[0] != is_on_lattice[1]; }
};

/// Compares two results of one case, ours or GenCase's, however many particles they have.
///
/// Pairs: particles at the same place (of the same mk first, of the same id first), then, among
/// those left, the nearest ones of the same mk within dp: in each of four rounds those pairs are
/// made whose particles are the nearest to each other. What is left is missing or extra.
/// Spacing and Shepard sums (Wendland, h = 1.3 dp) are of the particles of one file alone: at a
/// free surface or a wall of one layer the sum is below 1 in both. Of pairs, ids, densities,
/// velocities and normals are compared. Of Case.xml, all elements and attributes are compared
/// (numbers by value; date and maker are not), and of Case.bi4 all values.
///
/// name_a, name_b  as read_particles() takes them: a case without extension, or one file
/// returns  the same for any number of threads and any `particles_at_once`
/// throws   CompareError if a file cannot be read or is not whole, the results are not of one case
///          (no mk in common, or hardly any space), or a particle is not at a
///          finite place
/// cost     Files are mapped, never copied. Space is cut into slabs across its longest axis, so
///          that a slab and 9 dp on both sides hold `particles_at_once` particles of both files at
///          most, but it is never thinner than 1.3 dp: memory is about 160 bytes per particle of
///          such a slab, 16 bytes for every 32,768 particles of a file, the meshes, and a few
///          kilobytes per mk and thread. A hundred million particles in a cube, cut into single
///          layers, need 0.4 GB a file. About 1 microsecond a particle on one core
Comparison compare_results(const std::string& name_a, const std::string& name_b,
                           const CompareOptions& options);

/// Particles of a result for a picture: all, or where there are more than `most`, the first of
/// every cube of some dp, with this size as dp. throws CompareError
std::array<ParticleCloud, 2> clouds_for_picture(const Comparison& comparison, std::size_t most);

/// For people. Neither threads nor memory nor time are in it.
std::string to_text(const Comparison& comparison);

/// For programs: one JSON object, its numbers with all digits.
std::string to_json(const Comparison& comparison);

struct ComparePicture
{
    std::string caption;
    std::vector<std::pair<std::string, std::string>> legend; ///< colour as "#rrggbb", meaning
    std::string png;                                         ///< the bytes of the file
};

/// One HTML page that needs no other file: what to_text() says, with pictures and histograms, and
/// the times and warnings of Case.out where it stands beside a result.
///
/// view  HTML that is shown behind the pictures; may be empty
std::string to_html(const Comparison& comparison, const std::vector<ComparePicture>& pictures,
                    const std::string& view = {});

} // namespace fppg
