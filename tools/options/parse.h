// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <limits>
#include <string>
#include <vector>

namespace deltasplat {

/// Turns the text given to an option into a value. Numbers are taken whole, finite and in range.
/// @throw Error(kUsage) "<option>: got <text>; expected ..."
template <class T>
using Parser = std::function<T(const std::string& option, const std::string& text)>;

Parser<std::string> anyText();
/// One of the words, spelt exactly.
Parser<std::string> choice(std::vector<std::string> words);
Parser<double> number(double min = -std::numeric_limits<double>::infinity(),
                      double max = std::numeric_limits<double>::infinity());
Parser<std::int64_t> wholeNumber(std::int64_t min = 0,
                                 std::int64_t max = std::numeric_limits<std::int64_t>::max());
/// Bytes, with K, M, G or T for powers of 1024: "400M", "1.5G".
Parser<std::uint64_t> byteCount();
/// `X,Y,Z`, each within `most`, with which one can still reckon.
Parser<glm::dvec3> vector3(double most = 1e30);
/// A world length, or what is multiplied by one.
Parser<double> positiveLength();
/// Degrees, more than 0 and less than 180.
Parser<double> angleOfView();
/// Degrees of which the fractions still count.
Parser<double> angle();
/// `X,Y,Z`, world lengths of a voxel whose volume is still an ordinary number.
Parser<glm::dvec3> voxelSpacing();
/// `LO,HI` with LO < HI.
Parser<glm::dvec2> interval();
/// `R,G,B` or `R,G,B,A`; colours at least 0, A (default 1) within 0..1.
Parser<glm::vec4> color();
/// `WxH`, positive lengths.
Parser<glm::dvec2> lengthPair();
/// `X,Y`, each within `most`.
Parser<glm::dvec2> vector2(double most);
/// 16 numbers, row by row, of a matrix that points are multiplied with as rows, so that the
/// translation is the last row but its end; returned for columns. Commas or spaces between.
Parser<glm::dmat4> matrix4();
/// Two whole numbers of at least 1, written as `form`.
Parser<glm::ivec2> pixelSize(const std::string& form = "WxH");
/// `AxBxC`, whole numbers; whether they make a volume is for its reader to say.
Parser<glm::i64vec3> dimensions();

/// Returns what stands before, between and behind separators; of an empty text one empty part.
std::vector<std::string> splitAt(const std::string& text, char separator);
/// Returns the numbers' texts, joined by `separator`.
std::string joinNumbers(const std::vector<double>& values, const std::string& separator);
/// Returns the words as one text: "a, b or c".
std::string joinWords(const std::vector<std::string>& words, const std::string& last);
/// The same with commas alone: "a, b, c".
std::string joinNames(const std::vector<std::string>& names);

}  // namespace deltasplat
