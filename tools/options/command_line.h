// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "options/parse.h"

namespace deltasplat {

/// The heading of the options that every subcommand has.
inline constexpr const char* kCommonTitle = "Everywhere";

/// Options that every subcommand has.
struct CommonOptions {
    int quiet = 0;              ///< how often -q was given: 1 hides progress, 2 warnings as well
    bool verbose = false;       ///< say more
    bool progress = false;      ///< show progress on a pipe too
    bool alfProgress = false;   ///< in the words of Tractor and Alfred
    std::filesystem::path log;  ///< empty: none
    bool jsonLog = false;       ///< whether its lines are JSON objects
    int threads = 0;
    std::uint64_t maxMemory = 0;  ///< bytes; 0: no limit
    std::string simd = "auto";
    bool fsync = false;
};

/// What a subcommand knows about the run it is part of.
struct Session {
    CommonOptions common;
    std::string commandLine;  ///< as typed, program name without its folder
    std::chrono::steady_clock::time_point begin = std::chrono::steady_clock::now();
};

/// A subcommand: run() validates its options and does the work.
struct Subcommand {
    CLI::App* app = nullptr;
    /// Called before parsing if the arguments may call the subcommand: the options of all of them
    /// take longer than small volumes.
    std::function<void()> declareOptions;
    std::function<void(const Session&)> run;
    /// Asked after run(): the exit code, if it has more to say than that all went well.
    std::function<int()> exitCode = {};
    /// Exit code of everything that goes wrong but an interrupt; empty: one for each ErrorCode.
    std::optional<int> errorExit = {};
    /// Subcommands of its own, of which one may be called in its place.
    std::vector<Subcommand> nested = {};
};

/// Options shown under one heading of the help.
class OptionGroup {
  public:
    OptionGroup(CLI::App& app, std::string title) : app_(app), title_(std::move(title)) {}

    /// Declares an option with a value, or (without leading dashes) a positional argument.
    /// @param names        for example "-o,--output"; the last one stands in messages
    /// @param placeholder  what the help shows in place of the value
    /// @param target       receives what `parse` makes of the text; must outlive the parsing
    template <class T, class Target>
    CLI::Option& addValue(const std::string& names, const std::string& placeholder, Target& target,
                          Parser<T> parse, const std::string& help) {
        const std::string name = names.substr(names.rfind(',') + 1);
        return *app_.add_option_function<std::string>(
                        names,
                        [&target, parse, name](const std::string& text) {
                            target = static_cast<Target>(parse(name, text));
                        },
                        help)
                    ->type_name(placeholder)
                    ->take_last()
                    ->group(title_);
    }
    /// Declares an option with a value that may be given several times.
    template <class T>
    void addEach(const std::string& name, const std::string& placeholder, std::vector<T>& target,
                 Parser<T> parse, const std::string& help) {
        app_.add_option_function<std::vector<std::string>>(
                name,
                [&target, parse, name](const std::vector<std::string>& texts) {
                    for (const std::string& text : texts) target.push_back(parse(name, text));
                },
                help)
            ->type_name(placeholder)
            ->expected(1)
            ->take_all()
            ->group(title_);
    }
    /// Declares a pair of flags that say yes and no; of several the last counts.
    void addSwitch(const std::string& yes, const std::string& no, std::optional<bool>& target,
                   const std::string& help) {
        app_.add_flag_function(
                yes + ",!" + no, [&target](std::int64_t count) { target = count > 0; }, help)
            ->multi_option_policy(CLI::MultiOptionPolicy::TakeLast)
            ->group(title_);
    }
    void addFlag(const std::string& names, bool& target, const std::string& help) {
        app_.add_flag(names, target, help)->group(title_);
    }
    /// Declares an option that is answered in place of what the subcommand does, whatever else is
    /// given or missing, with a value or without: what follows it is its value, unless that is an
    /// option. The answer is told whether the subcommand was asked for more, options of
    /// addCommonOptions aside.
    void addQuestion(const std::string& name, const std::string& placeholder,
                     const std::function<void(const std::string& value, bool isMoreGiven)>& answer,
                     const std::string& help) {
        app_.add_option_function<std::string>(
                name,
                [&app = app_, name, answer](const std::string& value) {
                    answer(value, isMoreGiven(app, name));
                    throw CLI::Success();
                },
                help)
            ->type_name(placeholder)
            ->expected(0, 1)
            ->group(title_);
    }
    /// Declares a flag that counts how often it is given, here and wherever else `target` is.
    void addCount(const std::string& names, int& target, const std::string& help) {
        app_.add_flag_function(
                names, [&target](std::int64_t count) { target += int(count); }, help)
            ->group(title_);
    }

  private:
    static bool isMoreGiven(const CLI::App& app, const std::string& name);

    CLI::App& app_;
    std::string title_;
};

/// Returns `help` with the default as it stands in an options struct: "help (default 512x512)".
std::string withDefault(const std::string& help, const std::string& value);

/// Returns whether the option stands on the command line; false while that is not yet parsed.
bool isGiven(const CLI::App& app, const std::string& name);

/// Declares a subcommand, of the program or of another one, with an empty set of options.
/// @param examples  command lines, shown below the help
CLI::App& addSubcommand(CLI::App& program, const std::string& name, const std::string& summary,
                        const std::vector<std::string>& examples);

/// Declares `-h`, `--version`, `-q`, `-v`, `--progress`, `--threads`, `--max-memory` and `--simd`.
void addCommonOptions(CLI::App& app, CommonOptions& options);

/// @throw Error(kUsage) if the argument was not given
void requireArgument(bool given, const std::string& name, const std::string& expected);

}  // namespace deltasplat
