/*
 * Command lines of the tools: one table of options gives parsing, messages and the page of --help.
 *
 * Options may stand anywhere among the other arguments, as `--name value`, `--name=value` or
 * `-o value`; `--` ends them.  What is wrong is said as `error: what; what to do`.
 */
#ifndef TREMIE_POSTPROC_OPTIONS_H
#define TREMIE_POSTPROC_OPTIONS_H

#include <stdbool.h>

enum options_kind {
    OPTIONS_FLAG,   /* bool */
    OPTIONS_TEXT,   /* const char * */
    OPTIONS_NUMBER, /* double, finite */
    OPTIONS_CHOICE, /* int: index into `choices` */
};

struct options_entry {
    const char *name; /* without the dashes */
    char letter;      /* short form; 0 when there is none */
    enum options_kind kind;
    void *value;          /* where it goes; keeps what it holds when the option is absent */
    const char *argument; /* how --help calls the value */
    const char *help;
    const char *const *choices; /* NULL-terminated */
};

struct options_page {
    const char *tool;  /* tremie-... */
    const char *usage; /* what follows the tool's name */
    const char *about; /* lines of text, the exit statuses among them */
    int n_entries;
    const struct options_entry *entries;
    int n_least, n_most; /* other arguments: how many there may be */
};

enum { OPTIONS_GO_ON = -1 };

/*
 * Reads the command line; the other arguments are moved to argv[1..*n].  Returns OPTIONS_GO_ON, or the
 * status to exit with: 0 after --help, 2 after a mistake, which has been said.
 */
int options_read(const struct options_page *page, int argc, char **argv, int *n);

#endif
