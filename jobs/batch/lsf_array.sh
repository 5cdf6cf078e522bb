#!/bin/bash
#BSUB -J "study[1-6]"
#BSUB -n 8
#BSUB -W 12:00
#BSUB -wt 5 -wa USR1
#BSUB -Q "75"
#BSUB -r
#BSUB -o study.%J.%I.log
# A study: a run for each variant of the job's sweep, in a folder of its own inside the study's.  LSF asks for a
# checkpoint five minutes before the limit, and requeues the elements that end with status 75 (-Q) or lose
# their host (-r).  Submit with  bsub < lsf_array.sh  from the folder that tremie is in.
# Change the lines above (as many elements of the array as `tremie check` lists variants), the job file and the
# study's folder.
job=jobs/outlet.yaml
study=runs/outlet

MACHINE=lsf exec config/launch bin/tremie run "$job" --out "$study" --variant "$LSB_JOBINDEX"
