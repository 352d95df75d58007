// SPDX-License-Identifier: Apache-2.0
#include "program.h"

#include <stdlib.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <new>
#include <optional>

#include "base/text.h"
#include "deltasplat/atomic_file.h"
#include "deltasplat/error.h"
#include "deltasplat/memory_limit.h"
#include "deltasplat/simd.h"
#include "deltasplat/threads.h"
#include "listener.h"
#include "process/interrupt.h"
#include "process/large_pages.h"
#include "process/print_out.h"
#include "process/reuse_memory.h"
#include "process/run_log.h"
#include "process/tell_place.h"
#include "process/terminate.h"

namespace deltasplat {
namespace {

// Writes an argument so that a shell reads it back as one word.
std::string quoted(const std::string& argument) {
    const std::string plain =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_@%+=:,./-";
    if (!argument.empty() && argument.find_first_not_of(plain) == std::string::npos)
        return argument;
    std::string text = "'";
    for (const char c : argument) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return text + "'";
}

int exitCodeOf(ErrorCode code) {
    switch (code) {
        case ErrorCode::kFailed:
            return 1;
        case ErrorCode::kUsage:
            return 2;
        case ErrorCode::kInput:
            return 3;
        case ErrorCode::kOutput:
            return 4;
        case ErrorCode::kInterrupted:
            return 130;
    }
    return 1;
}

std::string commandLine(const std::vector<std::string>& arguments) {
    std::string line = quoted(std::filesystem::path(arguments.at(0)).filename().string());
    for (std::size_t i = 1; i < arguments.size(); ++i) line += " " + quoted(arguments[i]);
    return line;
}

bool looksLikeOption(const std::string& argument) {
    return argument.size() > 1 && argument[0] == '-';
}

std::vector<std::string> longOptions(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options())
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    return names;
}

std::vector<std::string> subcommandNames(const std::vector<Subcommand>& subcommands) {
    std::vector<std::string> names;
    for (const Subcommand& subcommand : subcommands) names.push_back(subcommand.app->get_name());
    return names;
}

// Returns how an app is called: "deltasplat bench table1".
std::string callOf(const CLI::App& app) {
    const CLI::App* const parent = app.get_parent();
    return (parent == nullptr ? "" : callOf(*parent) + " ") + app.get_name();
}

// Returns the subcommand to run, the innermost one that was called; nullptr if none was.
const Subcommand* called(const std::vector<Subcommand>& subcommands) {
    for (const Subcommand& subcommand : subcommands) {
        if (!subcommand.app->parsed()) continue;
        const Subcommand* const nested = called(subcommand.nested);
        return nested != nullptr ? nested : &subcommand;
    }
    return nullptr;
}

// Which subcommand an argument is of, walking over them.
class CalledSubcommand {
  public:
    explicit CalledSubcommand(const std::vector<Subcommand>& subcommands)
        : callable_(&subcommands) {}

    // Returns the one that the next argument names or is of, or null.
    const CLI::App* next(const std::string& argument) {
        const auto named = std::find_if(callable_->begin(), callable_->end(), [&](const auto& s) {
            return s.app->get_name() == argument;
        });
        if (named == callable_->end()) return app_;
        callable_ = &named->nested;
        return app_ = named->app;
    }

  private:
    const CLI::App* app_ = nullptr;
    const std::vector<Subcommand>* callable_;
};

// Spells a long option of the subcommand with two dashes where it was written with one, as users of
// idiff and oiiotool do: "-fail" is no "-f ail"; and what CLI11 takes for the value "=x" of "-o=x"
// as
// "-ox". What follows "--" is no option.
void spellWithTwoDashes(std::vector<std::string>& arguments,
                        const std::vector<Subcommand>& subcommands) {
    CalledSubcommand called(subcommands);
    for (std::string& argument : arguments) {
        if (argument == "--") break;
        const CLI::App* const app = called.next(argument);
        if (app == nullptr || argument.size() < 3 || argument[0] != '-') continue;
        const std::string name = "-" + argument.substr(0, argument.find('='));
        if (app->get_option_no_throw(name) != nullptr) argument.insert(0, 1, '-');
        const bool isShort = argument.size() > 3 && argument[1] != '-' && argument[2] == '=';
        if (isShort && app->get_option_no_throw(argument.substr(0, 2)) != nullptr)
            argument.erase(2, 1);
    }
}

Error nothingGiven(const CLI::App& app, const std::string& name, const CLI::Option& option) {
    return Error(ErrorCode::kUsage, gotExpected(name, "nothing", option.get_type_name()) +
                                        " (see '" + callOf(app) + " --help')");
}

// Refuses empty values of options, as of a shell's variable that is not set: none is one, and for
// the one of "--name=" CLI11 would take the next argument.
void refuseEmptyValues(const CLI::App& program, const std::vector<std::string>& arguments,
                       const std::vector<Subcommand>& subcommands) {
    CalledSubcommand called(subcommands);
    for (std::size_t i = 0; i < arguments.size() && arguments[i] != "--"; ++i) {
        const std::string& argument = arguments[i];
        const CLI::App* const subcommand = called.next(argument);
        const CLI::App& app = subcommand == nullptr ? program : *subcommand;
        if (!looksLikeOption(argument)) continue;
        const std::size_t sign = argument.find('=');
        const std::string name = argument.substr(0, sign);
        const bool isEmpty = sign == std::string::npos
                                 ? i + 1 < arguments.size() && arguments[i + 1].empty()
                                 : sign + 1 == argument.size();
        const CLI::Option* const option = isEmpty ? app.get_option_no_throw(name) : nullptr;
        if (option == nullptr || option->get_items_expected_max() == 0) continue;
        // A grid may have no name.
        const bool mayBeEmpty = sign == std::string::npos && name == "--grid";
        if (!mayBeEmpty) throw nothingGiven(app, name, *option);
    }
}

// Joins an option that may have a value with what follows it, unless that is an option: CLI11 takes
// it for an argument of the subcommand if one is missing, and then nobody knows which it is.
void joinPossibleValues(std::vector<std::string>& arguments,
                        const std::vector<Subcommand>& subcommands) {
    CalledSubcommand called(subcommands);
    for (std::size_t i = 0; i + 1 < arguments.size() && arguments[i] != "--"; ++i) {
        const CLI::App* const app = called.next(arguments[i]);
        if (app == nullptr || looksLikeOption(arguments[i + 1])) continue;
        const CLI::Option* const option = app->get_option_no_throw(arguments[i]);
        if (option == nullptr || option->get_positional()) continue;
        if (option->get_items_expected_max() == 0 || option->get_items_expected_min() > 0) continue;
        arguments[i] += "=" + arguments[i + 1];
        arguments.erase(arguments.begin() + std::ptrdiff_t(i) + 1);
    }
}

// Spells "help render" as "render --help", as users of git do; what is no subcommand is refused as
// it is without "help".
void askForHelp(std::vector<std::string>& arguments, const std::vector<Subcommand>& subcommands) {
    if (arguments.empty() || arguments.front() != "help") return;
    arguments.erase(arguments.begin());
    const std::vector<std::string> names = subcommandNames(subcommands);
    const bool isKnown = arguments.empty() || std::count(names.begin(), names.end(), arguments[0]);
    if (isKnown && arguments.size() < 2) arguments.emplace_back("--help");
}

// Refuses the first argument that the program or the subcommand does not know.
void refuseExtras(const CLI::App& app, const std::vector<Subcommand>& subcommands) {
    std::vector<std::string> extras = app.remaining();
    // It has done its work.
    const auto end = std::find(extras.begin(), extras.end(), "--");
    if (end != extras.end()) extras.erase(end);
    if (extras.empty()) return;
    const auto option = std::find_if(extras.begin(), extras.end(), looksLikeOption);
    const bool isProgram = app.get_parent() == nullptr;
    if (isProgram && !looksLikeOption(extras.front())) {
        throw Error(ErrorCode::kUsage,
                    "Unknown subcommand '" + extras.front() + "'." +
                        suggestion(extras.front(), subcommandNames(subcommands)) + " Expected " +
                        joinWords(subcommandNames(subcommands), "or"));
    }
    if (option != extras.end()) {
        const std::string name = option->substr(0, option->find('='));
        const bool isOutput =
            (name == "-o" || name == "--output") && app.get_option_no_throw("OUTPUT") != nullptr;
        throw Error(ErrorCode::kUsage, "Unknown option '" + name + "'." +
                                           (isOutput ? " OUTPUT is the last argument, without one"
                                                     : suggestion(name, longOptions(app))));
    }
    throw Error(ErrorCode::kUsage,
                "Unexpected argument '" + extras.front() + "'; see '" + callOf(app) + " --help'" +
                    // A shell has put files in a pattern's place.
                    (app.get_name() == "render" ? " (many files: a pattern in quotes)" : ""));
}

// Puts what CLI11 has to say into our words.
Error usageError(const CLI::App& app, const CLI::ParseError& problem) {
    const std::string text = problem.what();
    const std::string line = text.substr(0, text.find('\n'));
    const std::string name = line.substr(0, std::min(line.find(": "), line.find(" is required")));
    const CLI::Option* const option = app.get_option_no_throw(name);
    if (option == nullptr || name == line) return Error(ErrorCode::kUsage, line);
    if (option->get_type_name().empty())
        return Error(ErrorCode::kUsage, name, "a value", "none, it is a flag");
    return nothingGiven(app, name, *option);
}

// Declares the options of a subcommand that an argument names, as it must to call it, and of those
// nested in it.
void declareIfNamed(const Subcommand& subcommand, const std::vector<std::string>& arguments,
                    CommonOptions& common) {
    CLI::App& app = *subcommand.app;
    if (std::find(arguments.begin() + 1, arguments.end(), app.get_name()) == arguments.end())
        return;
    subcommand.declareOptions();
    addCommonOptions(app, common);
    for (const Subcommand& nested : subcommand.nested) declareIfNamed(nested, arguments, common);
}

// Parses the arguments; returns the subcommand to run, or nullptr if help or versions were shown.
const Subcommand* parse(CLI::App& program, const std::vector<Subcommand>& subcommands,
                        const std::vector<std::string>& arguments) {
    std::vector<std::string> spelt(arguments.begin() + 1, arguments.end());
    askForHelp(spelt, subcommands);
    spellWithTwoDashes(spelt, subcommands);
    refuseEmptyValues(program, spelt, subcommands);
    joinPossibleValues(spelt, subcommands);
    std::vector<std::string> reversed(spelt.rbegin(), spelt.rend());
    try {
        program.parse(reversed);
    } catch (const CLI::Success& shown) {
        std::ostringstream text;
        program.exit(shown, text, text);
        printOut(text.str());
        return nullptr;
    } catch (const CLI::ParseError& problem) {
        const Subcommand* const subcommand = called(subcommands);
        const CLI::App& app = subcommand == nullptr ? program : *subcommand->app;
        // A misspelt option is why another one seems to be missing.
        refuseExtras(app, subcommands);
        throw usageError(app, problem);
    }
    refuseExtras(program, subcommands);
    const Subcommand* const subcommand = called(subcommands);
    if (subcommand == nullptr) {
        throw Error(ErrorCode::kUsage, gotExpected("subcommand", "nothing",
                                                   joinWords(subcommandNames(subcommands), "or")) +
                                           " (see 'deltasplat --help')");
    }
    for (const CLI::App* app = subcommand->app; app != &program; app = app->get_parent())
        refuseExtras(*app, subcommands);
    return subcommand;
}

// Returns how many threads to use: fewer than asked for, or than there are cores, where so many
// cannot be started.
int threadsFor(const CommonOptions& options) {
    const int wanted = options.threads > 0 ? options.threads : ThreadLimit::hardwareThreads();
    // Beside the one there is, N threads mean N - 1 of the library's, N - 1 of OpenImageIO's and N
    // of OpenEXR's; and of OpenVDB's library those that it starts (log4cplus).
    constexpr int kOfOpenVdb = 4;
    const int startable =
        wanted > 1 ? startableThreads(3 * wanted - 2 + kOfOpenVdb) - kOfOpenVdb : 0;
    const int threads = std::clamp((startable + 2) / 3, 1, wanted);
    // What OpenImageIO makes for itself when it is first used: as many as there are cores, else.
    ::setenv("OPENIMAGEIO_THREADS", std::to_string(threads).c_str(), 1);
    if (threads < wanted && !options.quiet) {
        std::fprintf(stderr,
                     "deltasplat: warning: threads: %d instead of %d, for no more can be "
                     "started\n",
                     threads, wanted);
    }
    return threads;
}

// Runs the program; returns its exit code. Sets `errorExit` as soon as there is a subcommand that
// has one.
int execute(const std::vector<std::string>& arguments,
            const std::vector<AddSubcommand>& addSubcommands, std::optional<int>& errorExit) {
    Session session;
    session.commandLine = commandLine(arguments);

    CLI::App program("Renders sparse volumes by splatting what changes from slice to slice.",
                     "deltasplat");
    program.get_formatter()->column_width(32);
    program.require_subcommand(0, 1);
    program.allow_extras();
    program.footer("'deltasplat help SUBCOMMAND' explains a subcommand.");
    addCommonOptions(program, session.common);
    std::vector<Subcommand> subcommands;
    for (const AddSubcommand add : addSubcommands) {
        subcommands.push_back(add(program));
        declareIfNamed(subcommands.back(), arguments, session.common);
        const auto code = subcommands.back().errorExit;
        subcommands.back().app->preparse_callback([&errorExit, code](std::size_t) {
            errorExit = code;
            setTerminateExitCode(code.value_or(exitCodeOf(ErrorCode::kFailed)));
        });
    }

    const Subcommand* const subcommand = parse(program, subcommands, arguments);
    if (subcommand == nullptr) return 0;
    if (session.common.jsonLog && session.common.log.empty()) {
        throw Error(ErrorCode::kUsage, "--json-log", "it without --log", "a file to add lines to");
    }
    if (!session.common.log.empty()) openRunLog(session.common.log, session.common.jsonLog);
    logLine(LogLevel::kInfo, session.commandLine);
    setSimdLevel(session.common.simd);
    const ThreadLimit limit(threadsFor(session.common));
    setSyncFiles(session.common.fsync);
    setMemoryLimit(session.common.maxMemory);
    // What is kept counts as taken.
    if (session.common.maxMemory == 0) {
        reuseMemory();
        useLargePages();
    }
    subcommand->run(session);
    return subcommand->exitCode ? subcommand->exitCode() : 0;
}

int complain(const std::vector<std::string>& arguments, const std::string& what, int exitCode) {
    showError(what);
    const auto asked = [](const std::string& a) { return a == "-v" || a == "--verbose"; };
    // Looked up as typed, because what failed may be the parsing.
    if (std::any_of(arguments.begin(), arguments.end(), asked))
        std::fprintf(stderr, "  command line: %s\n", printable(commandLine(arguments)).c_str());
    return exitCode;
}

// An interrupt also makes a blocked system call fail, which is then not what went wrong.
int fail(const std::vector<std::string>& arguments, const std::string& what, ErrorCode code,
         std::optional<int> errorExit) {
    if (isInterrupted()) return complain(arguments, "interrupted", interruptExitCode());
    // As of programs that the signal ends: `| head` has seen enough.
    if (isReaderGone()) return 128 + SIGPIPE;
    return complain(arguments, what, errorExit.value_or(exitCodeOf(code)));
}

}  // namespace

namespace {

int runLogged(const std::vector<std::string>& arguments,
              const std::vector<AddSubcommand>& addSubcommands) {
    std::optional<int> errorExit;
    try {
        return execute(arguments, addSubcommands, errorExit);
    } catch (const Error& error) {
        return fail(arguments, error.what(), error.code(), errorExit);
    } catch (const std::bad_alloc&) {
        return fail(arguments, "out of memory", ErrorCode::kFailed, errorExit);
    } catch (const std::exception& error) {
        return fail(arguments, describe(error), ErrorCode::kFailed, errorExit);
    }
}

}  // namespace

int runProgram(const std::vector<std::string>& arguments,
               const std::vector<AddSubcommand>& addSubcommands) {
    handleSignals();
    tellPlaceOnSignal();
    const int exitCode = runLogged(arguments, addSubcommands);
    logEnd(exitCode);
    return exitCode;
}

}  // namespace deltasplat
