// SPDX-License-Identifier: Apache-2.0
#include "base/memory.h"

#include <gtest/gtest.h>

#include <limits>

#include "unit/temp_folder.h"

namespace deltasplat {
namespace {

constexpr std::uint64_t kNone = std::numeric_limits<std::uint64_t>::max();

// A machine's root folder, with what /proc and /sys/fs/cgroup tell.
class Machine {
  public:
    void write(const std::string& file, const std::string& text) const {
        const std::filesystem::path path = folder_ / file;
        std::filesystem::create_directories(path.parent_path());
        std::ofstream(path) << text;
    }
    void process(const std::string& cgroup, const std::string& mountinfo) const {
        write("proc/self/cgroup", cgroup);
        write("proc/self/mountinfo", mountinfo);
    }
    std::uint64_t available() const { return cgroupAvailable(folder_.path()); }
    int processors() const { return cgroupProcessors(folder_.path()); }

  private:
    test::TempFolder folder_;
};

// As systemd has it, and as Slurm nests a step in a job.
const char* const kUnified =
    "23 1 0:20 / /proc rw - proc proc rw\n"
    "31 23 0:27 / /sys/fs/cgroup rw,nosuid shared:9 - cgroup2 cgroup2 rw,nsdelegate\n";
const char* const kSplit =
    "31 23 0:28 / /sys/fs/cgroup rw - tmpfs tmpfs rw,mode=755\n"
    "32 31 0:29 / /sys/fs/cgroup/cpu,cpuacct rw shared:4 - cgroup cgroup rw,cpu,cpuacct\n"
    "35 31 0:32 / /sys/fs/cgroup/memory rw shared:5 master:1 - cgroup cgroup rw,memory\n"
    "41 31 0:38 / /sys/fs/cgroup/unified rw - cgroup2 cgroup2 rw\n";

TEST(Cgroup, WithoutOneThereIsNoLimit) {
    const Machine machine;
    EXPECT_EQ(machine.available(), kNone);
    machine.process("0::/\n", kUnified);
    EXPECT_EQ(machine.available(), kNone);
    machine.write("sys/fs/cgroup/memory.max", "max\n");
    EXPECT_EQ(machine.available(), kNone);
}

TEST(Cgroup, FindsTheNestedGroupOfVersion2) {
    const Machine machine;
    machine.process("0::/system.slice/job 7.scope/step:0\n", kUnified);
    const std::string job = "sys/fs/cgroup/system.slice/job 7.scope/";
    machine.write(job + "step:0/memory.max", "400000000\n");
    EXPECT_EQ(machine.available(), 400000000u);
    // The group around it has less.
    machine.write(job + "memory.max", "300000000\n");
    EXPECT_EQ(machine.available(), 300000000u);
    machine.write("sys/fs/cgroup/system.slice/memory.max", "max\n");
    machine.write("sys/fs/cgroup/elsewhere/memory.max", "1\n");
    EXPECT_EQ(machine.available(), 300000000u);
}

// What is in use and cannot make room is not there; page cache can.
TEST(Cgroup, CountsWhatIsInUseButNotThePageCache) {
    const Machine machine;
    machine.process("0::/a/b\n", kUnified);
    machine.write("sys/fs/cgroup/a/memory.max", "1000\n");
    machine.write("sys/fs/cgroup/a/memory.current", "700\n");
    machine.write("sys/fs/cgroup/a/memory.stat",
                  "anon 250\nfile 450\nshmem 50\ninactive_file 300\nactive_file 100\n");
    machine.write("sys/fs/cgroup/a/b/memory.max", "900\n");
    machine.write("sys/fs/cgroup/a/b/memory.current", "100\n");
    EXPECT_EQ(machine.available(), 700u);  // of a: 1000 - (700 - 400); of b: 900 - 100
    machine.write("sys/fs/cgroup/a/b/memory.current", "950\n");
    EXPECT_EQ(machine.available(), 0u);
}

TEST(Cgroup, FindsTheNestedGroupOfVersion1) {
    const Machine machine;
    machine.process("5:cpu,cpuacct:/other\n4:hugetlb,memory:/slurm/job\n0::/init\n", kSplit);
    const std::string slurm = "sys/fs/cgroup/memory/slurm/";
    machine.write("sys/fs/cgroup/memory/memory.limit_in_bytes", "9223372036854771712\n");
    EXPECT_EQ(machine.available(), 9223372036854771712u);
    machine.write(slurm + "job/memory.limit_in_bytes", "5000\n");
    EXPECT_EQ(machine.available(), 5000u);
    machine.write(slurm + "memory.limit_in_bytes", "4000\n");
    machine.write(slurm + "memory.usage_in_bytes", "1500\n");
    machine.write(slurm + "memory.stat",
                  "inactive_file 7\ntotal_inactive_file 300\ntotal_active_file 200\n");
    EXPECT_EQ(machine.available(), 3000u);  // 4000 - (1500 - 500)
}

// A container may see only its own part of the hierarchy, under names of outside or of inside.
TEST(Cgroup, SeesWhatAContainerSees) {
    const Machine machine;
    machine.write("sys/fs/cgroup/memory.max", "2000\n");
    const char* const kPart = "31 23 0:27 /docker/abc /sys/fs/cgroup ro - cgroup2 cgroup2 rw\n";
    machine.process("0::/docker/abc\n", kPart);
    EXPECT_EQ(machine.available(), 2000u);
    machine.write("sys/fs/cgroup/inner/memory.max", "1000\n");
    machine.process("0::/docker/abc/inner\n", kPart);
    EXPECT_EQ(machine.available(), 1000u);
    machine.process("0::/docker/abcinner\n", kPart);
    EXPECT_EQ(machine.available(), 2000u);
    machine.process("0::/../inner\n", kUnified);
    EXPECT_EQ(machine.available(), 2000u);
}

TEST(Cgroup, FindsMountPointsWithBlanks) {
    const Machine machine;
    machine.process("0::/a\n", "31 23 0:27 / /my\\040groups rw - cgroup2 cgroup2 rw\n");
    machine.write("my groups/a/memory.max", "77\n");
    EXPECT_EQ(machine.available(), 77u);
}

TEST(Cgroup, FindsTheProcessorsOfVersion2) {
    constexpr int kAll = std::numeric_limits<int>::max();
    const Machine machine;
    EXPECT_EQ(machine.processors(), kAll);
    machine.process("0::/slurm/job\n", kUnified);
    EXPECT_EQ(machine.processors(), kAll);
    machine.write("sys/fs/cgroup/slurm/job/cpu.max", "max 100000\n");
    EXPECT_EQ(machine.processors(), kAll);
    machine.write("sys/fs/cgroup/slurm/cpu.max", "400000 100000\n");
    EXPECT_EQ(machine.processors(), 4);
    // A part of one is one.
    machine.write("sys/fs/cgroup/slurm/job/cpu.max", "110000 100000\n");
    EXPECT_EQ(machine.processors(), 2);
    machine.write("sys/fs/cgroup/slurm/job/cpu.max", "1000 100000\n");
    EXPECT_EQ(machine.processors(), 1);
    machine.write("sys/fs/cgroup/slurm/job/cpu.max", "1000 0\n");
    EXPECT_EQ(machine.processors(), 4);
}

TEST(Cgroup, FindsTheProcessorsOfVersion1) {
    constexpr int kAll = std::numeric_limits<int>::max();
    const Machine machine;
    machine.process("5:cpu,cpuacct:/job\n4:memory:/other\n0::/init\n", kSplit);
    const std::string cpu = "sys/fs/cgroup/cpu,cpuacct/";
    machine.write(cpu + "job/cpu.cfs_quota_us", "-1\n");
    machine.write(cpu + "job/cpu.cfs_period_us", "50000\n");
    EXPECT_EQ(machine.processors(), kAll);
    machine.write(cpu + "job/cpu.cfs_quota_us", "150000\n");
    EXPECT_EQ(machine.processors(), 3);
    machine.write(cpu + "cpu.cfs_quota_us", "100000\n");
    EXPECT_EQ(machine.processors(), 3);
    machine.write(cpu + "cpu.cfs_period_us", "100000\n");
    EXPECT_EQ(machine.processors(), 1);
}

}  // namespace
}  // namespace deltasplat
