// sphinxsys_reload DP STEPS
//
// A program of SPHinXsys that reloads the body "ball", a ball of 1 m about the origin, from
// reload/Reload.xml, and relaxes it. Writes moved.txt: x y z of every particle before and after.
//
// For check_readers.py sphinxsys. Not built here: SPHinXsys is no package of Debian. Build its 3D
// library (-DSPHINXSYS_2D=OFF -DSPHINXSYS_BUILD_TESTS=OFF) and then this file with the options that
// its compile_commands.json has for any of its files, linked to libsphinxsys_3d.a, SimTKsimbody,
// SimTKmath, SimTKcommon, tbb, boost_program_options and fmt.

#include "sphinxsys.h"

#include <fstream>
#include <string>
#include <vector>

int main(int count, char* words[])
{
    using namespace SPH;
    if (count != 3) return 2;
    const Real dp = std::stod(words[1]);
    SPHSystem system(BoundingBoxd(Vec3d(-1.5, -1.5, -1.5), Vec3d(1.5, 1.5, 1.5)), dp);
    system.setReloadParticles(true);
    RealBody body(system, makeShared<GeometricShapeBall>(Vec3d(0, 0, 0), 1.0, "ball"));
    body.defineBodyLevelSetShape();
    body.generateParticles<BaseParticles, Reload>("ball");
    InnerRelation inner(body);
    relax_dynamics::RelaxationStepInner step(inner);
    BaseParticles& particles = body.getBaseParticles();
    const Vecd* at = particles.getVariableDataByName<Vecd>("Position");
    const std::size_t n = particles.TotalRealParticles();
    const std::vector<Vecd> before(at, at + n);
    body.updateCellLinkedList();
    inner.updateConfiguration();
    for (int i = 0; i < std::stoi(words[2]); ++i)
    {
        step.exec();
        body.updateCellLinkedList();
        inner.updateConfiguration();
    }
    std::ofstream out("moved.txt");
    out.precision(17);
    for (std::size_t i = 0; i < n; ++i)
        out << before[i].transpose() << " " << at[i].transpose() << "\n";
    return out ? 0 : 1;
}
