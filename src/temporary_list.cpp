// SPDX-License-Identifier: Apache-2.0
#include "temporary_list.h"

#include <fcntl.h>
#include <limits.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstring>
#include <memory>

#include "deltasplat/atomic_file.h"

namespace deltasplat {

struct TemporaryEntry {
    enum State : int { kFree, kChanging, kTemporary };
    std::atomic<int> state{kFree};
    int folder = -1;
    std::array<char, NAME_MAX + 1> name{};
};

namespace {

using Entry = TemporaryEntry;

// A list that only grows, so that signal handlers can walk it at any time.
struct Entries {
    std::array<Entry, 64> some;
    std::atomic<Entries*> next = nullptr;
};
Entries first;

bool take(Entry& entry, int state) {
    return entry.state.compare_exchange_strong(state, Entry::kChanging);
}

Entry& takeFree() {
    for (Entries* part = &first;;) {
        for (Entry& entry : part->some)
            if (take(entry, Entry::kFree)) return entry;
        Entries* next = part->next;
        if (!next) {
            auto more = std::make_unique<Entries>();
            if (part->next.compare_exchange_strong(next, more.get())) next = more.release();
        }
        part = next;
    }
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

TemporaryEntry* listTemporary(const NameInFolder& file) {
    Entry& entry = takeFree();
    entry.folder = file.folder;
    std::strncpy(entry.name.data(), file.name.c_str(), NAME_MAX);
    entry.state = Entry::kTemporary;
    return &entry;
}

void unlist(TemporaryEntry* entry) noexcept {
    if (entry) entry->state = Entry::kFree;
}

void removeTemporaryFiles() noexcept {
    for (Entries* part = &first; part; part = part->next) {
        for (Entry& entry : part->some)
            if (take(entry, Entry::kTemporary)) ::unlinkat(entry.folder, entry.name.data(), 0);
    }
}

}  // namespace deltasplat
