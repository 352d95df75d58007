// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace deltasplat {

/// Makes the tag of a file from its content, so that the same content has the same tag.
class ContentTag {
  public:
    /// Takes the bytes that follow.
    void add(const char* bytes, std::size_t count);
    /// Returns a UUID of version 8 (free use, RFC 9562) that stands for all bytes.
    std::string text();

  private:
    void hashBlock();

    std::uint64_t hash_ = 0xcbf29ce484222325u;
    std::vector<char> block_;  // of the bytes that are not hashed yet
};

}  // namespace deltasplat
