#!/bin/bash
#SBATCH --job-name=hopper-chain
#SBATCH --dependency=singleton
#SBATCH --ntasks=8
#SBATCH --time=12:00:00
#SBATCH --signal=B:USR1@120
#SBATCH --open-mode=append
# A chain: submit it as often as the run may need jobs.  Those of one name and user run one after the
# other, however each ends; when the run has ended those left over do nothing.
# Change the lines above, the job file and the run's folder.
job=${JOB:-jobs/hopper.yaml}
run=${RUN:-runs/hopper}

MACHINE=slurm exec config/launch bin/tremie run "$job" --out "$run"
