import json,subprocess,sys
scene=sys.argv[1]; a,b=int(sys.argv[2]),int(sys.argv[3]); dt=1/240
prev=None
def works(o):
    w={}
    def rec(n,d):
        if 'work' in d: w[n]=d['work']+0*d.get('created',0); w[n+'+corr']=d.get('created_by_correction',0)
        for k,v in d.items():
            if isinstance(v,dict): rec(n+'.'+k,v)
    for n,d in o['interactions'].items(): rec(n,d)
    return w
for s in range(a,b+1):
    subprocess.run(['/work/main/build/bin/plabd',scene,'--no-bus','--until',str(s*dt),'--out','o.json'],capture_output=True)
    o=json.load(open('o.json')); w=works(o)
    l=o['ledger']
    if prev and abs(l['unexplained']-prev[0])>1e-3:
        print(s,o['step'],'d unexplained',l['unexplained']-prev[0],{k:round(v-prev[1].get(k,0),5) for k,v in w.items() if abs(v-prev[1].get(k,0))>1e-6})
    prev=(l['unexplained'],w)
