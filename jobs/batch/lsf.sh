#!/bin/bash
#BSUB -J hopper
#BSUB -n 8
#BSUB -W 12:00
#BSUB -wt 5 -wa USR1
#BSUB -Q "75"
#BSUB -r
#BSUB -o hopper.%J.log
# LSF asks for a checkpoint five minutes before the limit, and requeues what ends with status 75 (-Q) or
# loses its host (-r).  Submit with  bsub < lsf.sh  from the folder that tremie is in.
# Change the lines above, the job file and the run's folder.
job=jobs/hopper.yaml
run=runs/hopper

MACHINE=lsf exec config/launch bin/tremie run "$job" --out "$run"
