// SPDX-License-Identifier: Apache-2.0
// Every data set, as delta grids and back: nothing changes; with a tolerance, nothing changes by
// more.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "deltasplat/convert/write_volume.h"
#include "deltasplat/delta/delta_file.h"
#include "deltasplat/diff/compare_volumes.h"
#include "deltasplat/ingest/read_volume.h"
#include "unit/ingest_helpers.h"
#include "volume/tree_grid.h"
#include "volume/tree_types.h"

namespace deltasplat {
namespace {

namespace fs = std::filesystem;

// Names that volumes begin with; a data file of a header (.mhd's .raw) is not read by itself.
std::vector<fs::path> inputs() {
    std::vector<fs::path> found;
    const fs::path data = DELTASPLAT_SHARED_DATA;
    if (!fs::is_directory(data)) return found;
    for (const auto& entry : fs::recursive_directory_iterator(data)) {
        const std::string name = entry.path().filename().string();
        const bool vdb = name.ends_with(".vdb");
        const bool raw = name.find("_uint") != std::string::npos;
        if (vdb || raw) found.push_back(entry.path());
    }
    std::sort(found.begin(), found.end());
    return found;
}

ReadOptions keeping() {
    ReadOptions options;
    options.keepSource = true;
    options.levelSetToFog = false;
    return options;
}

// Metadata but what OpenVDB itself counts when it writes a file.
openvdb::MetaMap::Ptr comparable(const openvdb::GridBase& grid) {
    auto metadata = grid.copyMeta();
    std::vector<std::string> counted;
    for (auto entry = metadata->beginMeta(); entry != metadata->endMeta(); ++entry) {
        if (entry->first.starts_with("file_")) counted.push_back(entry->first);
    }
    for (const std::string& name : counted) metadata->removeMeta(name);
    return metadata;
}

void expectSameGrid(const Volume& source, const Volume& restored) {
    ASSERT_TRUE(source.source() && restored.source());
    const openvdb::GridBase::Ptr kept = toOpenVdb(source.source()->grid);
    const openvdb::GridBase::Ptr back = toOpenVdb(restored.source()->grid);
    const openvdb::GridBase &a = *kept, &b = *back;
    EXPECT_EQ(a.type(), b.type());
    EXPECT_EQ(a.transform(), b.transform());
    EXPECT_EQ(a.activeVoxelCount(), b.activeVoxelCount());
    EXPECT_EQ(*comparable(a), *comparable(b));
}

void expectRestored(const Volume& source, const DeltaFileEntry& entry, const Volume& restored) {
    SCOPED_TRACE(source.name());
    const VolumeComparison same = compareVolumes(source, restored);
    EXPECT_TRUE(same.typeEqual && same.classEqual && same.nameEqual && same.transformEqual);
    EXPECT_EQ(source.space(), restored.space());
    EXPECT_EQ(same.activeMismatch, 0u);
    EXPECT_EQ(same.backgroundError, 0);
    EXPECT_EQ(same.maxError, 0);
    EXPECT_EQ(entry.maxError, 0);
    EXPECT_TRUE(entry.lossless);
    if (source.hasBackground()) expectSameGrid(source, restored);
}

// Volumes of one file, and what was said of them as they became delta grids.
struct Sources {
    std::vector<Volume> volumes;
    std::vector<DeltaFileEntry> entries;
};

// Makes delta.vdb of them, and expects them back.
void expectAllComeBack(Sources& sources, bool pack) {
    SCOPED_TRACE(pack ? "packed" : "voxels");
    DeltaFileOptions options;
    options.pack = pack;
    DeltaFile deltas;
    sources.entries.clear();
    for (const Volume& volume : sources.volumes)
        sources.entries.push_back(deltas.add(volume, options));
    deltas.write("delta.vdb");
    const std::vector<Volume> restored = readAllVolumes("delta.vdb", keeping());
    ASSERT_EQ(restored.size(), sources.volumes.size());
    for (std::size_t i = 0; i < restored.size(); ++i)
        expectRestored(sources.volumes[i], sources.entries[i], restored[i]);
}

// Bytes of the delta grids in delta.vdb as a share of the volumes' bytes as an ordinary .vdb.
double ratioOf(Sources sources) {
    writeVolumes("plain.vdb", std::move(sources.volumes));
    return double(fs::file_size("delta.vdb")) / double(fs::file_size("plain.vdb"));
}

// What docs/performance.md says of them, and a little room.
void expectWorthTheirBytes(std::vector<double> ratios) {
    for (const double ratio : ratios) EXPECT_LE(ratio, 1.25);
    std::sort(ratios.begin(), ratios.end());
    EXPECT_LE(ratios[ratios.size() / 2], 0.7);
    EXPECT_LT(ratios[ratios.size() * 85 / 100], 1);
}

TEST(DeltaData, EveryVolumeComesBack) {
    const auto files = inputs();
    if (files.empty()) GTEST_SKIP() << "no data sets at " << DELTASPLAT_SHARED_DATA;
    EXPECT_GE(files.size(), 55u);
    std::string exact;
    std::vector<double> ratios;
    for (const fs::path& file : files) {
        SCOPED_TRACE(file.string());
        const testing::TempFolder folder;
        Sources sources{readAllVolumes(file, keeping()), {}};
        expectAllComeBack(sources, /*pack=*/false);
        for (const DeltaFileEntry& entry : sources.entries) {
            if (entry.codeBook == "float32") exact += " " + file.filename().string();
        }
        expectAllComeBack(sources, /*pack=*/true);
        ratios.push_back(ratioOf(std::move(sources)));
    }
    expectWorthTheirBytes(ratios);
    // Only these have more different 32-bit values than there are codes, or than a table is worth.
    EXPECT_EQ(exact,
              " test.vdb densityAndHeat.vdb densityAndHeat.vdb smoke_000002.vdb smoke_000003.vdb");
}

// What a tolerance promises, on the real thing: scanner noise, smoke, a field that never ends.
TEST(DeltaData, TolerancesHold) {
    const fs::path data = DELTASPLAT_SHARED_DATA;
    if (!fs::is_directory(data)) GTEST_SKIP() << "no data sets at " << DELTASPLAT_SHARED_DATA;
    const char* const files[] = {
        "engine/engine_256x256x128_uint8.raw.gz", "tooth/tooth_103x94x161_uint16be.raw.gz",
        "vdb_smoke/smoke.vdb", "vdb_plume_seq/fluid_data_0200.vdb", "vdb_anisotropic_fog/test.vdb"};
    for (const char* const file : files) {
        SCOPED_TRACE(file);
        const testing::TempFolder folder;
        const Volume source = readVolume(data / file, keeping());
        DeltaFileOptions options;
        const std::uint64_t exact = DeltaFile().add(source, options).deltas;
        options.tolerance.value = 0.02 * (source.valueMax() - source.valueMin());
        for (const bool pack : {false, true}) {
            options.pack = pack;
            DeltaFile deltas;
            const DeltaFileEntry entry = deltas.add(source, options);
            deltas.write("delta.vdb");
            const VolumeComparison held =
                compareVolumes(source, readVolume("delta.vdb", keeping()));
            EXPECT_LE(held.maxError, options.tolerance.value);
            EXPECT_EQ(held.maxError, entry.maxError);
            EXPECT_EQ(held.activeMismatch, 0u);
            EXPECT_LT(entry.deltas, exact);
        }
    }
}

}  // namespace
}  // namespace deltasplat
