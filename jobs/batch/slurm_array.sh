#!/bin/bash
#SBATCH --job-name=study
#SBATCH --array=1-6
#SBATCH --ntasks=8
#SBATCH --time=12:00:00
#SBATCH --signal=B:USR1@120
#SBATCH --requeue
#SBATCH --open-mode=append
# A study: a run for each variant of the job's sweep, in a folder of its own inside the study's; each requeues
# itself until it has ended.
# Change the lines above (as many elements of the array as `tremie check` lists variants), the job file and the
# study's folder.
job=${JOB:-jobs/outlet.yaml}
study=${STUDY:-runs/outlet}

AGAIN=yes MACHINE=slurm exec config/launch bin/tremie run "$job" --out "$study" --variant "$SLURM_ARRAY_TASK_ID"
