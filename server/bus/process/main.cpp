// plab-bus: the only process of a server that maps DDS. Only plabd starts it, and restarts it when it ends.
#include "bus/process/program.h"

int main(int argc, char** argv)
{
    return plab::bus::run_program(argc, argv, "plab-bus", "carries the topics of one server between it and DDS", nullptr);
}
