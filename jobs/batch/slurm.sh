#!/bin/bash
#SBATCH --job-name=hopper
#SBATCH --ntasks=8
#SBATCH --time=12:00:00
#SBATCH --signal=B:USR1@120
#SBATCH --open-mode=append
# One job.  When it stops before the run has ended (exit status 75), submit it again: it goes on.
# Change the lines above, the job file and the run's folder.
job=${JOB:-jobs/hopper.yaml}
run=${RUN:-runs/hopper}

MACHINE=slurm exec config/launch bin/tremie run "$job" --out "$run"
