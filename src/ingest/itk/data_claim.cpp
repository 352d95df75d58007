// SPDX-License-Identifier: Apache-2.0
#include "ingest/itk/data_claim.h"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <fstream>
#include <system_error>

#include "deltasplat/error.h"
#include "ingest/files/refuse_file.h"
#include "ingest/itk/text_header.h"
#include "lower_case.h"
#include "printable.h"

namespace deltasplat {
namespace {

// ITK writes an orientation wherever it takes world space for a patient's, which is then LPS.
bool isOrientation(const std::string& text) {
    return text.size() == 3 && text.find_first_not_of("RLAPSI") == std::string::npos;
}

// Data in a list or a numbered series of files, or on standard input, is not read. Names that begin
// with "c:", and for MetaIO "~", are not looked up beside the header.
void setDetached(const std::filesystem::path& file, const std::string& name, DataClaim& claim) {
    const bool elsewhere = name.starts_with('~') || (name.size() > 1 && name[1] == ':');
    if (name.empty() || name == "-" || lowerCase(name).rfind("list", 0) == 0 || elsewhere ||
        name.find('%') != std::string::npos) {
        refuseFile(file, "data in \"" + printable(name) + "\"", "the name of one data file");
    }
    claim.dataFile = file.parent_path() / name;
    std::error_code error;
    if (!std::filesystem::is_regular_file(claim.dataFile, error)) {
        refuseFile(file, "no data file \"" + printable(name) + "\"", "a readable file");
    }
    claim.dataBytes = std::filesystem::file_size(claim.dataFile);
}

void setAttached(const std::filesystem::path& file, const TextHeader& header, DataClaim& claim) {
    claim.dataFile = file;
    claim.dataStart = header.dataStart;
    claim.dataBytes = std::filesystem::file_size(file) - header.dataStart;
}

const std::string& require(const std::filesystem::path& file, const TextHeader& header,
                           const std::string& field) {
    const std::string* value = header.find(field);
    if (value == nullptr) refuseFile(file, "a header without " + field, "a whole one");
    return *value;
}

std::string withoutBlanksAndDashes(const std::string& text) {
    std::string letters;
    for (const char c : lowerCase(text)) {
        if (c != ' ' && c != '-') letters += c;
    }
    return letters;
}

// Returns the whole number of a field, or `missing`.
std::int64_t numberOf(const std::filesystem::path& file, const TextHeader& header,
                      const std::string& field, std::int64_t missing) {
    const std::string* value = header.find(field);
    if (value == nullptr) return missing;
    std::int64_t number = 0;
    const char* const end = value->data() + value->size();
    const auto result = std::from_chars(value->data(), end, number);
    if (result.ec != std::errc{} || result.ptr != end) {
        refuseFile(file, field + " " + printable(*value), "a whole number");
    }
    return number;
}

// Lines are passed over before the data are unpacked, and bytes afterwards.
void setGzip(const std::filesystem::path& file, const TextHeader& header, DataClaim& claim) {
    claim.encoding = DataClaim::Encoding::kGzip;
    const std::int64_t bytes = numberOf(file, header, "byteskip", 0);
    const std::int64_t lines = numberOf(file, header, "lineskip", 0);
    if (bytes < 0 || lines < 0) {
        refuseFile(file,
                   "line skip " + std::to_string(lines) + " and byte skip " +
                       std::to_string(bytes) + " of packed data",
                   "whole numbers from 0 on");
    }
    claim.skippedBytes = std::uint64_t(bytes);
    std::ifstream in(claim.dataFile, std::ios::binary);
    in.seekg(std::streamoff(claim.dataStart));
    std::uint64_t passed = 0;
    for (std::int64_t line = 0; line < lines; ++passed) {
        const int c = in.get();
        if (c < 0)
            refuseFile(claim.dataFile, "fewer than " + std::to_string(lines) + " lines",
                       "those that are to be skipped");
        if (c == '\n') ++line;
    }
    claim.dataStart += passed;
    claim.dataBytes -= passed;
}

}  // namespace

DataClaim claimOfNrrd(const std::filesystem::path& file) {
    const TextHeader header = readNrrdHeader(file);
    DataClaim claim;
    claim.sizes = parseSizes(file.string(), require(file, header, "sizes"));
    const std::string* name = header.find("datafile");
    if (name != nullptr) {
        setDetached(file, *name, claim);
    } else {
        setAttached(file, header, claim);
    }
    const std::string encoding = lowerCase(require(file, header, "encoding"));
    if (encoding == "gzip" || encoding == "gz") {
        setGzip(file, header, claim);
    } else if (encoding != "raw") {
        claim.encoding = DataClaim::Encoding::kText;
    }
    if (const std::string* space = header.find("space")) {
        const std::string letters = withoutBlanksAndDashes(*space);
        if (letters == "ras" || letters == "rightanteriorsuperior") claim.space = "RAS";
        if (letters == "las" || letters == "leftanteriorsuperior") claim.space = "LAS";
        if (letters == "lps" || letters == "leftposteriorsuperior") claim.space = "LPS";
    }
    return claim;
}

namespace {

// Bytes to pass over in the data file, and of packed data: MetaIO allocates what they say.
void checkMetaData(const std::filesystem::path& file, const TextHeader& header, DataClaim& claim) {
    const std::int64_t skipped = numberOf(file, header, "headersize", 0);
    const std::int64_t packed = numberOf(file, header, "compresseddatasize", 0);
    const auto held = std::int64_t(claim.dataBytes);
    if (skipped < -1 || skipped > held || packed < 0 ||
        packed > held - std::max<std::int64_t>(skipped, 0)) {
        refuseFile(file,
                   "HeaderSize " + std::to_string(skipped) + " and CompressedDataSize " +
                       std::to_string(packed),
                   "at most the " + std::to_string(held) + " bytes of data");
    }
    if (skipped > 0 && claim.dataFile == file) {
        refuseFile(file, "HeaderSize " + std::to_string(skipped) + " for data in the same file",
                   "0");
    }
    if (skipped <= 0) return;
    claim.dataStart += std::uint64_t(skipped);
    claim.dataBytes -= std::uint64_t(skipped);
}

// MetaIO takes three spellings for data in the same file; it takes a backslash in the header's name
// for a slash, and drops what is not ASCII at the end of a data file's.
bool isLocal(const std::filesystem::path& file, const std::string& name) {
    if (name == "LOCAL" || name == "Local" || name == "local") return true;
    const bool cut = !name.empty() && static_cast<signed char>(name.back()) < 0;
    if (lowerCase(name) == "local" || cut) {
        refuseFile(file, "data in \"" + printable(name) + "\"",
                   "LOCAL or the name of one data file");
    }
    if (file.filename().string().find('\\') != std::string::npos) {
        refuseFile(file, "a backslash in the header's name", "a name without");
    }
    return false;
}

}  // namespace

DataClaim claimOfMeta(const std::filesystem::path& file) {
    const TextHeader header = readMetaHeader(file);
    DataClaim claim;
    claim.sizes = parseSizes(file.string(), require(file, header, "dimsize"));
    const std::string name = header.fields.back().value;
    if (isLocal(file, name)) {
        setAttached(file, header, claim);
    } else {
        setDetached(file, name, claim);
    }
    const std::string* orientation = header.find("anatomicalorientation");
    if (orientation != nullptr && isOrientation(*orientation)) claim.space = "LPS";
    const auto isTrue = [&](const std::string& field) {
        const std::string* value = header.find(field);
        return value != nullptr && !value->empty() && std::strchr("Tt1", (*value)[0]) != nullptr;
    };
    // MetaIO counts up to NDims before it looks at anything else.
    const std::int64_t axes = numberOf(file, header, "ndims", 0);
    if (axes != std::int64_t(claim.sizes.size())) {
        refuseFile(file, "NDims = " + std::to_string(axes),
                   std::to_string(claim.sizes.size()) + ", as many as there are sizes");
    }
    // It has room for so many.
    constexpr std::int64_t kMostAxes = 10;
    if (axes > kMostAxes) {
        refuseFile(file, "NDims = " + std::to_string(axes), "at most " + std::to_string(kMostAxes));
    }
    checkMetaData(file, header, claim);
    const std::string* binary = header.find("binarydata");
    if (isTrue("compresseddata")) {
        claim.encoding = DataClaim::Encoding::kGzip;
    } else if (binary != nullptr && !isTrue("binarydata")) {
        claim.encoding = DataClaim::Encoding::kText;
    }
    return claim;
}

}  // namespace deltasplat
