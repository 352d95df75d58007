// SPDX-License-Identifier: Apache-2.0
#include "temporary_list.h"

#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstring>

#include "deltasplat/atomic_file.h"

namespace deltasplat {
namespace {

using Name = std::array<char, NAME_MAX + 1>;

struct Entry {
    enum State : int { kFree, kChanging, kTemporary, kHeaderChange };
    std::atomic<int> state{kFree};
    int folder = -1;
    Name name{};  // of a temporary file, or of a header that is set aside
    // Of a header that changes:
    Name header{}, fresh{}, data{};
    int dataFolder = -1;
    FileIdentity placeholder, freshFile, freshData;
};
std::array<Entry, 64> entries;

void set(Name& to, const std::string& from) {
    std::strncpy(to.data(), from.c_str(), NAME_MAX);
}

int findFree() {
    for (std::size_t i = 0; i < entries.size(); ++i) {
        int expected = Entry::kFree;
        if (entries[i].state.compare_exchange_strong(expected, Entry::kChanging)) return int(i);
    }
    return -1;
}

// Only what signal handlers may do.
void settle(const Entry& change) {
    const int folder = change.folder;
    if (isAt(change.freshData, change.dataFolder, change.data.data())) {
        if (isAt(change.freshFile, folder, change.fresh.data()))
            ::renameat(folder, change.fresh.data(), folder, change.header.data());
        ::unlinkat(folder, change.name.data(), 0);
    } else if (isAt(change.placeholder, folder, change.name.data())) {
        ::unlinkat(folder, change.name.data(), 0);
    } else {
        ::renameat(folder, change.name.data(), folder, change.header.data());
    }
}

bool take(Entry& entry, int state) {
    return entry.state.compare_exchange_strong(state, Entry::kChanging);
}

}  // namespace

FileIdentity identityOf(const struct stat& status) {
    return {status.st_dev, status.st_ino};
}

FileIdentity identityOf(int file) {
    struct stat status {};
    return ::fstat(file, &status) == 0 ? identityOf(status) : FileIdentity{};
}

bool isAt(const FileIdentity& file, int folder, const char* name) {
    struct stat status {};
    return file != FileIdentity{} && ::fstatat(folder, name, &status, AT_SYMLINK_NOFOLLOW) == 0 &&
           identityOf(status) == file;
}

int listTemporary(const NameInFolder& file) {
    const int place = findFree();
    if (place < 0) return place;
    Entry& entry = entries[std::size_t(place)];
    entry.folder = file.folder;
    set(entry.name, file.name);
    entry.state = Entry::kTemporary;
    return place;
}

int listHeaderChange(const HeaderChange& change) {
    const int place = findFree();
    if (place < 0) return place;
    Entry& entry = entries[std::size_t(place)];
    entry.folder = change.header.folder;
    set(entry.name, change.aside);
    set(entry.header, change.header.name);
    set(entry.fresh, change.fresh);
    set(entry.data, change.data.name);
    entry.dataFolder = change.data.folder;
    entry.placeholder = change.placeholder;
    entry.freshFile = change.freshFile;
    entry.freshData = change.freshData;
    entry.state = Entry::kHeaderChange;
    return place;
}

void unlist(int place) noexcept {
    if (place >= 0) entries[std::size_t(place)].state = Entry::kFree;
}

void settleHeaderChange(int place) noexcept {
    if (place < 0) return;
    settle(entries[std::size_t(place)]);
    unlist(place);
}

void removeTemporaryFiles() noexcept {
    // A new header may have to get its name before temporary files are removed.
    for (Entry& entry : entries) {
        if (take(entry, Entry::kHeaderChange)) settle(entry);
    }
    for (Entry& entry : entries) {
        if (take(entry, Entry::kTemporary)) ::unlinkat(entry.folder, entry.name.data(), 0);
    }
}

}  // namespace deltasplat
