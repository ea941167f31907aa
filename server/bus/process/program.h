/// The program plab-bus, alone or with a companion: something else that lives in its process, and ends with it.
#pragma once

#include <memory>
#include <string>

#include "bus/channel/messages.h"

namespace plab::bus
{

class Companion
{
public:
    virtual ~Companion() = default;
};

/// Makes the companion once the bus has been joined; on a thread that does not preempt the step thread. Null: there is none.
using MakeCompanion = Result<std::unique_ptr<Companion>> (*)(const StartMessage&);

/// main() of such a program.
int run_program(int argc, char** argv, const std::string& name, const std::string& help, MakeCompanion make);

}  // namespace plab::bus
