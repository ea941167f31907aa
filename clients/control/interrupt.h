/// Ctrl-C and SIGTERM as a flag.
#pragma once

namespace plab::control
{

/// From now on SIGINT and SIGTERM set the flag. A second one ends the process as usual: nobody is locked in.
void catch_interrupts();
bool is_interrupted();

}  // namespace plab::control
