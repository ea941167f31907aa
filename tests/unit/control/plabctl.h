/// The real plabctl in a process of its own.
#pragma once

#include <doctest/doctest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "fake_server.h"
#include "support/text.h"

namespace plab::test
{

using Json = nlohmann::ordered_json;

struct Outcome
{
    int code = -1;
    std::string out, err;

    Json json() const { return Json::parse(out); }
    /// Lines of standard output.
    std::vector<std::string> lines() const
    {
        std::vector<std::string> all;
        std::istringstream in(out);
        for (std::string line; std::getline(in, line);) all.push_back(line);
        return all;
    }
};

/// Tests may run side by side, in several checkouts.
inline std::uint32_t test_domain() { return 60 + static_cast<std::uint32_t>(getpid()) % 150; }
inline std::string temporary(const std::string& name)
{
    return std::string(PLAB_BINARY_DIR) + "/control_" + std::to_string(getpid()) + "_" + name;
}

inline std::string take_text(const std::string& file)
{
    std::ifstream in(file);
    std::stringstream text;
    text << in.rdbuf();
    std::remove(file.c_str());
    return text.str();
}

/// `before`: environment and the like; the command may not take longer than 30 s.
inline Outcome shell(const std::string& before, const std::string& arguments)
{
    const std::string out = temporary("out"), err = temporary("err");
    const std::string command = before + " timeout 30 " + quoted(std::string(PLAB_BINARY_DIR) + "/bin/plabctl") + " " + arguments + " >" +
                                quoted(out) + " 2>" + quoted(err);
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128, take_text(out), take_text(err)};
}

inline Outcome plabctl(const std::string& arguments, const std::string& before = "")
{
    return shell(before, "--domain " + std::to_string(test_domain()) + " " + arguments);
}

/// For the server "lab": it is found at once, whereas without a name plabctl waits for other servers.
inline Outcome lab(const std::string& arguments, const std::string& before = "") { return plabctl("--server lab " + arguments, before); }

}  // namespace plab::test
