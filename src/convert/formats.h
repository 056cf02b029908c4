#pragma once

#include "fppg/convert.h"

#include <string>

namespace fppg
{

// The writers of the formats, one file each; their tables are in formats.cpp.
void write_csv(const ParticleFeed&, const std::string& path, int threads, ConvertedFiles& out);
void write_vtu(const ParticleFeed&, const std::string& path, int threads, ConvertedFiles& out);
/// A file for every body, named FILE_BODY.vtu.
void write_trixi(const ParticleFeed&, const std::string& path, int threads, ConvertedFiles& out);
void write_xdmf(const ParticleFeed&, const std::string& path, int threads, ConvertedFiles& out);
void write_pysph(const ParticleFeed&, const std::string& path, int threads, ConvertedFiles& out);
void write_sphinxsys(const ParticleFeed&, const std::string& path, int threads,
                     ConvertedFiles& out);
/// A file for every body, BODY_rld.xml in the folder of the path.
void write_sphinxsys_bodies(const ParticleFeed&, const std::string& path, int threads,
                            ConvertedFiles& out);
void write_bgeo(const ParticleFeed&, const std::string& path, int threads, ConvertedFiles& out);
void write_lammps_peri(const ParticleFeed&, const std::string& path, int threads,
                       ConvertedFiles& out);
void write_lammps_sphere(const ParticleFeed&, const std::string& path, int threads,
                         ConvertedFiles& out);
void write_lammps_sph(const ParticleFeed&, const std::string& path, int threads,
                      ConvertedFiles& out);
void write_ls_dyna(const ParticleFeed&, const std::string& path, int threads, ConvertedFiles& out);
void write_radioss(const ParticleFeed&, const std::string& path, int threads, ConvertedFiles& out);
void write_peridigm(const ParticleFeed&, const std::string& path, int threads, ConvertedFiles& out);
/// What the particles add up to.
void write_tally(const ParticleFeed&, const std::string& path, int threads, ConvertedFiles& out);

/// Says that volumes are all the same where the feed knows no others. For formats with volumes.
void say_volumes(const ParticleFeed& feed, ConvertedFiles& out);

/// Says that positions are rounded.
void say_single_positions(ConvertedFiles& out);

/// Says that a format has no room for normals and kinds, where the feed has them.
void say_no_walls(const ParticleFeed& feed, ConvertedFiles& out);

/// The same particles with z as y: other codes have plane cases in x and y. A feed in 3-D as it is.
ParticleFeed in_xy_plane(const ParticleFeed& feed, ConvertedFiles& out);

/// The range of all positions.
Box3 limits_of_feed(const ParticleFeed& feed, int threads);

} // namespace fppg
