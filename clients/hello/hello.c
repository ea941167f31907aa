/* The same in plain C, with nothing of pLab but idl/plab.idl: README.md says how to build it. */
#include <dds/dds.h>
#include <stdio.h>

#include "plab.h"

int main(int argc, char** argv)
{
    if (argc != 2) return fprintf(stderr, "usage: hello SERVER\n"), 2;
    const dds_entity_t participant = dds_create_participant(DDS_DOMAIN_DEFAULT, NULL, NULL);
    if (participant < 0) return fprintf(stderr, "hello: %s\n", dds_strretcode(participant)), 1;
    const dds_entity_t topic = dds_create_topic(participant, &plab_v2_Frame_desc, "plab/states", NULL, NULL);
    dds_qos_t* qos = dds_create_qos();
    dds_qset_partition1(qos, argv[1]); /* each server has the partition of its name */
    const dds_entity_t subscriber = dds_create_subscriber(participant, qos, NULL);
    const dds_entity_t reader = dds_create_reader(subscriber, topic, NULL, NULL);
    dds_delete_qos(qos);
    int printed = 0;
    for (int tries = 0; printed < 3 && tries < 5000; ++tries)
    {
        void* samples[1] = {NULL};
        dds_sample_info_t info[1];
        if (dds_take(reader, samples, info, 1, 1) <= 0)
        {
            dds_sleepfor(DDS_MSECS(1));
            continue;
        }
        const plab_v2_Frame* frame = samples[0];
        if (info[0].valid_data && frame->bodies._length > 0)
            printed++, printf("%8.3f s  z = %.3f m\n", frame->time, frame->bodies._buffer[0].position.z);
        dds_return_loan(reader, samples, 1);
    }
    dds_delete(participant);
    return printed == 3 ? 0 : 3;
}
