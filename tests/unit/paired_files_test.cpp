// SPDX-License-Identifier: Apache-2.0
// A header and its data file, written over older ones by processes that end in between.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>

#include "deltasplat/atomic_file.h"
#include "deltasplat/convert/write_volume.h"
#include "deltasplat/ingest/read_volume.h"
#include "unit/temp_folder.h"

namespace deltasplat {
namespace {

namespace fs = std::filesystem;
using test::readBytes;

constexpr int kEnded = 7;
int callsLeft = 0;

// Does something in a process of its own, for threads do not outlive a fork. Returns its exit code.
int inProcess(const std::function<void()>& work) {
    const pid_t child = ::fork();
    if (child == 0) {
        work();
        ::_exit(0);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return WEXITSTATUS(status);
}

void convert(const fs::path& from, const fs::path& to) {
    std::vector<Volume> volumes;
    volumes.push_back(readVolume(from));
    writeVolumes(to, std::move(volumes));
}

class PairedFiles : public testing::TestWithParam<std::pair<const char*, const char*>> {
  protected:
    PairedFiles() {
        std::ofstream(folder_ / "old_2x3x4_uint8.raw") << std::string(24, 'o');
        std::ofstream(folder_ / "new_2x3x4_uint8.raw") << std::string(24, 'n');
    }
    // Writes the new volume over the old one; ends without a word at the given change of names.
    int replaceUntil(int change) const {
        fs::remove(header());
        fs::remove(data());
        EXPECT_EQ(inProcess([&] { convert(folder_ / "old_2x3x4_uint8.raw", header()); }), 0);
        return inProcess([&] {
            callsLeft = change;
            setCommitGate([] {
                if (--callsLeft == 0) ::_exit(kEnded);
            });
            convert(folder_ / "new_2x3x4_uint8.raw", header());
        });
    }
    fs::path header() const { return folder_ / (std::string("out") + GetParam().first); }
    fs::path data() const { return folder_ / (std::string("out") + GetParam().second); }

    test::TempFolder folder_;
};

TEST_P(PairedFiles, AnOldHeaderNeverDescribesNewData) {
    EXPECT_EQ(replaceUntil(0), 0);
    const std::string newData = readBytes(data());
    int change = 1;
    for (; replaceUntil(change) == kEnded; ++change) {
        ASSERT_LT(change, 10);
        const bool oldData = readBytes(data()) != newData;
        EXPECT_TRUE(oldData || !fs::exists(header())) << "ended at change " << change;
    }
    // It is taken away, the data file gets its name, the header gets its name.
    EXPECT_EQ(change, 4);
    EXPECT_EQ(folder_.count(), 4) << "what ended processes left is removed";
    EXPECT_EQ(readBytes(data()), newData);
    EXPECT_TRUE(fs::exists(header()));
}

INSTANTIATE_TEST_SUITE_P(Formats, PairedFiles,
                         testing::Values(std::pair{".mhd", ".raw"}, std::pair{".nhdr", ".raw.gz"}),
                         [](const auto& format) { return std::string(format.param.first + 1); });

// What cannot be replaced is left with the header that describes it.
TEST(PairedFile, KeepsTheOldPairWhereItsDataCannotBeReplaced) {
    const test::TempFolder folder;
    std::ofstream(folder / "v_2x3x4_uint8.raw") << std::string(24, 'n');
    std::ofstream(folder / "out.mhd") << "old header";
    const int code = inProcess([&] {
        static fs::path data;
        data = folder / "out.raw";
        // After all checks, and after the header has been taken away, a folder is in the way.
        callsLeft = 2;
        setCommitGate([] {
            if (--callsLeft == 0) fs::create_directory(data);
        });
        try {
            convert(folder / "v_2x3x4_uint8.raw", folder / "out.mhd");
        } catch (const std::exception&) {
            ::_exit(kEnded);
        }
    });
    EXPECT_EQ(code, kEnded);
    EXPECT_EQ(readBytes(folder / "out.mhd"), "old header");
    EXPECT_EQ(folder.count(), 3);
}

}  // namespace
}  // namespace deltasplat
