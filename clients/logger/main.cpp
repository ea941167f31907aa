// plab-log: writes what happens in a server, line by line.
#include <iostream>

#include "logger/logger.h"
#include "logger/options.h"
#include "program/command_line.h"
#include "program/interruption.h"

using namespace plab;

int main(int argc, char** argv)
{
    logger::LoggerOptions options;
    if (const auto parsed = logger::parse_options(argc, argv, options))
    {
        (parsed->exit_code == 0 ? std::cout : std::cerr) << parsed->text;
        return parsed->exit_code;
    }
    program::catch_signals();
    const logger::End end = logger::follow(options, program::is_interrupted);
    for (const Error& error : end.errors) std::cerr << "plab-log: " << error.text() << "\n";
    return end.code == 0 && program::is_interrupted() ? program::code_of_interruption() : end.code;
}
