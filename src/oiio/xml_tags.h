// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace deltasplat {

/// The beginning of an element: `<ome:Pixels SizeX="4">`.
struct XmlTag {
    std::string name;  ///< without what stands before a colon
    std::map<std::string, std::string> attributes;
};

/// Takes one element after the other from a text of XML, those in others behind them. What lies
/// between, ends of elements, comments and declarations are passed over.
class XmlTags {
  public:
    /// @param text  must outlive this
    explicit XmlTags(std::string_view text) : text_(text) {}

    /// Returns nothing at the end, or where the text is no XML any more.
    std::optional<XmlTag> next();

  private:
    std::string_view takeUntil(std::string_view characters);
    void skipSpace();

    std::string_view text_;
};

}  // namespace deltasplat
