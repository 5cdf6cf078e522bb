/*
 * Command lines of the tools: one table of options gives parsing, messages and the page of
 * --help.
 *
 * Options may stand anywhere among the other arguments, as `--name value`, `--name=value` or
 * `-o value`; `--` ends them.  What is wrong is said as `error: what; what to do`.
 */
#ifndef TREMIE_POSTPROC_ARGUMENTS_H
#define TREMIE_POSTPROC_ARGUMENTS_H

#include <stdbool.h>

enum arguments_kind {
    ARGUMENTS_FLAG,   /* bool */
    ARGUMENTS_TEXT,   /* const char * */
    ARGUMENTS_NUMBER, /* double, finite */
    ARGUMENTS_CHOICE, /* int: index into `choices` */
};

struct arguments_entry {
    const char *name; /* without the dashes */
    char letter;      /* short form; 0 when there is none */
    enum arguments_kind kind;
    void *value;          /* where it goes; keeps what it holds when the option is absent */
    const char *argument; /* how --help calls the value */
    const char *help;
    const char *const *choices; /* NULL-terminated */
};

struct arguments_page {
    const char *tool;  /* tremie-... */
    const char *usage; /* what follows the tool's name */
    const char *about; /* lines of text, the exit statuses among them */
    int n_entries;
    const struct arguments_entry *entries;
    int n_least, n_most; /* other arguments: how many there may be */
};

enum { ARGUMENTS_GO_ON = -1 };

/*
 * Reads the command line; the other arguments are moved to argv[1..*n].  Returns
 * ARGUMENTS_GO_ON, or the status to exit with: 0 after --help, 2 after a mistake, which has
 * been said.
 */
int arguments_read(const struct arguments_page *page, int argc, char **argv, int *n);

#endif
