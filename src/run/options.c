/* See options.h. */
#include "run/options.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/report.h"
#include "job/sweep.h"
#include "run/wall_limit.h"

static const struct {
    const char *name;
    enum options_command command;
    bool takes_word;
} COMMANDS[] = {
    {"run", OPTIONS_RUN, true},
    {"check", OPTIONS_CHECK, true},
    {"status", OPTIONS_STATUS, true},
    {"stop", OPTIONS_STOP, true},
    {"reference", OPTIONS_REFERENCE, false},
    {"version", OPTIONS_VERSION, false},
    {"--version", OPTIONS_VERSION, false},
    {"help", OPTIONS_HELP, false},
    {"--help", OPTIONS_HELP, false},
    {"-h", OPTIONS_HELP, false},
};

static bool read_isa(struct options *options, const char *name)
{
    for (int isa = 0; isa < ISA_N; isa++) {
        if (strcmp(name, isa_name((enum isa)isa)) != 0)
            continue;
        options->isa = (enum isa)isa;
        if (isa_runs(options->isa))
            return true;
        report_error("--isa %s does not run here (processor or build lacks it); use --isa auto",
                     name);
        return false;
    }
    report_error("--isa %s is unknown; auto, generic, v2, v3 or v4 is expected", name);
    return false;
}

static bool read_wall(struct options *options, const char *text)
{
    if (wall_limit_read(text, &options->wall))
        return true;
    report_error("--wall %s is no time above 0; something like 12:00:00, '30 min' or 43200 "
                 "seconds is expected",
                 text);
    return false;
}

static bool read_variant(struct options *options, const char *text)
{
    char *end;
    const long number = strtol(text, &end, 10);
    options->variant = number > 0 && number <= SWEEP_MOST ? (int)number : 0;
    if (end != text && *end == '\0' && options->variant > 0)
        return true;
    report_error("--variant %s is no number of one; a whole number from 1 on is expected",
                 text);
    return false;
}

/* One option with its value; *used is how many words it took. */
static bool read_option(struct options *options, const char *word, const char *value, int *used)
{
    *used = 1;
    const struct {
        const char *name;
        bool *given;
    } flags[] = {{"--fresh", &options->fresh},
                 {"--take-over", &options->take_over},
                 {"--json", &options->json},
                 {"--advise", &options->advise}};
    for (size_t k = 0; k < sizeof flags / sizeof *flags; k++) {
        if (strcmp(word, flags[k].name) == 0) {
            *flags[k].given = true;
            return true;
        }
    }
    static const char *const with_value[] = {"--set", "--out",  "--restart",
                                             "--isa", "--wall", "--variant"};
    int which = -1;
    for (int k = 0; k < 6; k++)
        which = strcmp(word, with_value[k]) == 0 ? k : which;
    if (which < 0) {
        report_error("unknown option %s; see tremie --help", word);
        return false;
    }
    if (value == NULL) {
        report_error("%s needs a value; see tremie --help", word);
        return false;
    }
    *used = 2;
    if (which == 0)
        options->overrides[options->n_overrides++].text = value;
    else if (which == 1)
        options->out = value;
    else if (which == 2)
        options->restart = value;
    else if (which == 3)
        return read_isa(options, value);
    else if (which == 4)
        return read_wall(options, value);
    else
        return read_variant(options, value);
    return true;
}

static bool read_command(struct options *options, const char *word, bool *takes_word)
{
    for (size_t k = 0; k < sizeof COMMANDS / sizeof *COMMANDS; k++) {
        if (strcmp(word, COMMANDS[k].name) == 0) {
            options->command = COMMANDS[k].command;
            *takes_word = COMMANDS[k].takes_word;
            return true;
        }
    }
    report_error("unknown command %s; see tremie --help", word);
    return false;
}

bool options_read(struct options *options, int argc, char **argv)
{
    *options =
        (struct options){.overrides = array_allocate((size_t)argc, sizeof *options->overrides)};
    bool takes_word = false;
    const char *object = NULL;
    if (argc < 2) {
        report_error("tremie needs a command; see tremie --help");
        return false;
    }
    if (!read_command(options, argv[1], &takes_word))
        return false;
    for (int a = 2; a < argc;) {
        int used = 1;
        if (argv[a][0] == '-') {
            if (!read_option(options, argv[a], a + 1 < argc ? argv[a + 1] : NULL, &used))
                return false;
        } else if (object == NULL && takes_word) {
            object = argv[a];
        } else {
            report_error("%s is one word too many; see tremie --help", argv[a]);
            return false;
        }
        a += used;
    }
    if (takes_word && object == NULL) {
        report_error("tremie %s needs a %s; see tremie --help", argv[1],
                     options->command == OPTIONS_RUN || options->command == OPTIONS_CHECK
                         ? "job file"
                         : "run folder");
        return false;
    }
    options->job = options->run = object;
    if (options->fresh && options->restart != NULL) {
        report_error("--fresh and --restart exclude each other; use one of them");
        return false;
    }
    if (options->advise && options->command != OPTIONS_CHECK) {
        report_error("--advise goes with tremie check alone; leave it out");
        return false;
    }
    return true;
}

void options_clear(struct options *options)
{
    free(options->overrides);
    *options = (struct options){0};
}
