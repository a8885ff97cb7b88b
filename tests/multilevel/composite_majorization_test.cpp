// Composite majorization on whole disks: from where it starts, and when it starts elsewhere.
#include "multilevel/composite_majorization.h"

#include <gtest/gtest.h>

#include "base/work.h"
#include "descend/newton_loop.h"
#include "exact/certificate.h"
#include "mesh/disk_mesh.h"
#include "multilevel/descent.h"
#include "multilevel/options.h"
#include "support/disks.h"
#include "support/hard_disks.h"

namespace beltrami {
namespace {

TEST(MinimiseFromScratch, GivesAStartUpFromWhichItCrawls) {
  DiskMesh disk = disks::disk(disks::long_box());
  normalise(disk.positions, disk.faces, Work(1));
  for (const Injectivity injectivity : {Injectivity::kLocal, Injectivity::kGlobal}) {
    ChartOptions options;
    options.injectivity = injectivity;
    const Descent found = minimise_from_scratch(disk, options.tolerance, options, Work(1));
    EXPECT_TRUE(found.converged);
    EXPECT_LT(found.energy, 2.005);
    EXPECT_LT(found.iterations, newton::kHopefulSteps);  // of the start that served
    EXPECT_TRUE(non_positive_faces(disk.faces, found.uvs, Work(1)).empty());
  }
}

}  // namespace
}  // namespace beltrami
